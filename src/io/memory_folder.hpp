#pragma once

/// A folder in memory for what GDAL writes as several files, or only by copying.

#include <thalweg/io/pending_outputs.hpp>

#include <string>

namespace thalweg {

/// Made empty, and gone with everything in it when the object ends.
class MemoryFolder {
 public:
  /// `target` is the file that the user asked for; files here have its stem.
  explicit MemoryFolder(std::string target);
  ~MemoryFolder();
  MemoryFolder(const MemoryFolder&) = delete;
  MemoryFolder& operator=(const MemoryFolder&) = delete;

  /// The path for GDAL to write to: the target's name, in this folder.
  [[nodiscard]] const std::string& path() const { return path_; }

  /// Copies the main file to `written`, and every other to a file of its own name beside the target, by way
  /// of `pending`; a .prj that says the same stays. Throws: what `PendingOutputs::add` throws;
  /// Error{WriteFailed}.
  void deliver(const std::string& written, PendingOutputs& pending, Overwrite mode) const;

 private:
  std::string target_;
  std::string folder_;
  std::string path_;
};

}  // namespace thalweg
