#pragma once

/// Output files that appear whole or not at all.

#include <array>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace thalweg {

/// Whether an output may replace a file that exists.
enum class Overwrite : std::uint8_t { No, Yes };

/// Whether a target is written to from begin to end as it is, and has no place for files beside it: a pipe, a
/// character device, or an open descriptor of this process (/dev/stdout, /proc/self/fd/3, links to these).
bool is_stream(const std::string& target);
/// Whether a target is the standard output of this process.
bool is_standard_output(const std::string& target);

/// The files that one run will leave behind.
///
/// Each is written under a hidden name in its target's folder; `commit` gives all of them their names.
/// Whatever was not committed is removed by the destructor, so that an error or a cancel leaves nothing.
/// Laws: (1) before `commit` no target is touched; (2) after the destructor no temporary file is left;
/// (3) a committed file has been flushed to the device. Streams are written directly, and never removed.
class PendingOutputs {
 public:
  /// `sources`: files that the run reads. None of them, nor a file that belongs to one, is ever a target.
  explicit PendingOutputs(const std::vector<std::string>& sources = {});
  ~PendingOutputs();
  PendingOutputs(const PendingOutputs&) = delete;
  PendingOutputs& operator=(const PendingOutputs&) = delete;

  /// Checks that `target` can be written and returns the path to write to: no file is there yet, the folder
  /// and the extension are those of the target. A target that is a symbolic link is followed. Throws:
  /// Error{NotFound} if the folder is missing, Error{OutputExists} if the target exists and `mode` is No,
  /// Error{Usage} if it is a folder, a block device or socket, a source, or was added before,
  /// Error{WriteFailed} if the folder cannot be written. A stream is written to by this path, too.
  std::string add(const std::string& target, Overwrite mode);

  /// Says at once what `add` would refuse after long work: its writer adds the target then. Throws: as `add`,
  /// and if another output that was planned has this name.
  void plan(const std::string& target, Overwrite mode);

  /// Sees to it that no file `target` is left after `commit`: one that would be taken for a part of the
  /// outputs. Throws: Error{OutputExists} if there is one and `mode` is No.
  void remove_stale(const std::string& target, Overwrite mode);

  /// Flushes every added file to the device and renames it to its target. Throws: Error{WriteFailed},
  /// naming the file; Error{OutputExists} if meanwhile there is one that was not to be overwritten.
  void commit();

 private:
  struct Output {
    std::string target;
    std::string written;  ///< the temporary path; the target itself for streams
    Overwrite mode = Overwrite::No;
    std::array<std::string, 3> remains;  ///< of `written`; made before, for memory may be why it is removed
    [[nodiscard]] bool is_file() const { return written != target; }
  };
  static void check_new(const Output& output, const std::vector<Output>& known);
  /// What becomes of a target, if it can be written. Throws: as `add`.
  [[nodiscard]] Output output_of(const std::string& target, Overwrite mode) const;

  void remove_written() const noexcept;
  friend bool abandon_pending_outputs() noexcept;

  std::vector<std::string> sources_;
  std::vector<Output> outputs_, planned_;
  std::vector<std::string> stale_;
  bool committed_ = false;  ///< files may have got their names
};

/// Writes a text to the path that `PendingOutputs::add` gave for `target`. Throws: Error{WriteFailed} naming
/// the target, if not every byte could be written.
void write_text(const std::string& path, const std::string& target, std::string_view text);

/// For a process that is to end now, whatever its other threads are doing: removes the temporary files of
/// every PendingOutputs in it; `add` and `commit` then do not return any more. False, and nothing is done, if
/// files were given their names and no PendingOutputs is left that is yet to do so: then let the process end
/// by itself. Allocates nothing. Not for signal handlers.
bool abandon_pending_outputs() noexcept;

}  // namespace thalweg
