// Outputs that appear whole or not at all.
//
// 1. The temporary file lies in the target's own folder, so that the rename never crosses a file system and
//    is atomic.
// 2. Whether the folder can be written is asked by creating that file and removing it again: permission bits
//    say nothing about read-only file systems, or to root.
// 3. On commit: fsync every file, rename every file, fsync every folder (else a power cut may undo the
//    rename).
// 4. All that live are listed, so that a process which is told to end can remove their files while its other
//    threads are still at work. The lock of the list is held while names change and files are given their
//    targets, and is not given back once they were abandoned.
// 5. An open descriptor stands as the name of a link in /proc/self/fd; what this leads to may have no name
//    (pipe:[...]), or be a file that others go on to write to, so it is neither resolved nor replaced.
#include "base/lower_case.hpp"
#include "io/dataset.hpp"
#include "io/file_writer.hpp"

#include <thalweg/base/error.hpp>
#include <thalweg/io/pending_outputs.hpp>

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <mutex>
#include <optional>
#include <random>
#include <string>
#include <system_error>
#include <utility>

namespace thalweg {

namespace fs = std::filesystem;

namespace {

std::string describe_errno(int error) {
  return std::generic_category().message(error);
}

fs::path folder_of(const fs::path& file) {
  return file.has_parent_path() ? file.parent_path() : fs::path(".");
}

std::string random_word() {
  static const unsigned word = std::random_device()();
  return std::to_string(word);
}

// A name that no file of the folder has, proved by creating it.
fs::path unused_path(const fs::path& target) {
  static std::atomic<unsigned> counter{0};
  const fs::path folder = folder_of(target);
  while (true) {
    // Numbers of processes are the same in two containers that share the folder.
    const std::string name = ".thalweg-" + std::to_string(::getpid()) + "-" + random_word() + "-" +
                             std::to_string(counter++) + target.extension().string();
    const fs::path path = folder / name;
    const int file = ::open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
    if (file >= 0) {
      ::close(file);
      ::unlink(path.c_str());
      return path;
    }
    if (errno != EEXIST) {
      throw Error(ErrorCode::WriteFailed, target.string() + ": the folder '" + folder.string() +
                                              "' cannot be written (" + describe_errno(errno) +
                                              "); choose another one or change its permissions");
    }
  }
}

void sync_to_device(const fs::path& path, const std::string& target) {
  const int file = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  const bool synced = file >= 0 && (::fsync(file) == 0 || errno == EINVAL || errno == EROFS);
  const int error = errno;
  if (file >= 0) ::close(file);
  if (!synced) {
    throw Error(ErrorCode::WriteFailed, target + ": cannot be flushed to the device (" +
                                            describe_errno(error) + "); nothing was left behind");
  }
}

/// What a chain of links leads to, whether or not it is there.
fs::path behind_links(const std::string& target) {
  constexpr int kMost = 40;
  fs::path path = target;
  std::error_code ignored;
  for (int i = 0; i < kMost; ++i) {
    if (!fs::is_symlink(fs::symlink_status(path, ignored))) return path;
    const fs::path next = fs::read_symlink(path, ignored);
    path = next.is_absolute() ? next : folder_of(path) / next;
  }
  throw Error(ErrorCode::WriteFailed, target + ": is a link that leads nowhere; remove it");
}

/// What the file or stream is called by, for those that are not resolved.
std::string name_of_descriptor(int descriptor) {
  return "/proc/self/fd/" + std::to_string(descriptor);
}

Error exists_already(const std::string& target) {
  return {ErrorCode::OutputExists,
          target + ": exists already; choose another name or overwrite it with --overwrite"};
}

// False, and errno is set, if it did not work. Some file systems cannot look and rename in one step.
bool give_name(const std::string& written, const std::string& target, Overwrite mode) {
  if (mode == Overwrite::No) {
    if (::renameat2(AT_FDCWD, written.c_str(), AT_FDCWD, target.c_str(), RENAME_NOREPLACE) == 0) return true;
    if (errno != EINVAL && errno != ENOSYS) return false;
    if (::access(target.c_str(), F_OK) == 0) {
      errno = EEXIST;
      return false;
    }
  }
  return ::rename(written.c_str(), target.c_str()) == 0;
}

// What SQLite may leave beside a database when it is stopped.
std::array<std::string, 3> remains_of(const std::string& database) {
  return {database + "-journal", database + "-wal", database + "-shm"};
}

bool is_database(const fs::path& target) {
  return extension_of(target.native()) == ".gpkg";
}

// What such remains hold would be taken for a part of the new database.
void refuse_open_database(const std::string& target) {
  if (!is_database(target)) return;
  for (const char* remains : {"-journal", "-wal"}) {
    std::error_code not_there;
    const std::uintmax_t size = fs::file_size(target + remains, not_there);
    if (not_there || size == 0) continue;
    throw Error(ErrorCode::WriteFailed,
                target + ": another program has it open, or did not close it (" + target + remains +
                    " is not empty); close it there, or open and close it, or choose another name");
  }
}

/// Those that live. Never destroyed: a thread may wait for the lock while the process ends.
struct Living {
  std::mutex lock;
  std::vector<const PendingOutputs*> all;
  bool committed = false;  ///< one of them, which may be gone by now
};

Living& living() {
  static auto* const list = new Living;
  return *list;
}

}  // namespace

void write_text(const std::string& path, const std::string& target, std::string_view text) {
  FileWriter file(path, target);
  file.text(text);
  file.close();
}

bool is_stream(const std::string& target) {
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  return fs::is_character_file(status) || fs::is_fifo(status) || descriptor_of(target).has_value();
}

bool is_standard_output(const std::string& target) {
  return descriptor_of(target) == STDOUT_FILENO;
}

PendingOutputs::PendingOutputs(const std::vector<std::string>& sources) {
  for (const std::string& source : sources) {
    for (std::string& file : files_of_source(source)) sources_.push_back(std::move(file));
  }
  const std::scoped_lock lock(living().lock);
  living().all.push_back(this);
}

PendingOutputs::~PendingOutputs() {
  const std::scoped_lock lock(living().lock);
  remove_written();
  std::erase(living().all, this);
}

void PendingOutputs::remove_written() const noexcept {
  for (const Output& output : outputs_) {
    if (!output.is_file()) continue;
    ::unlink(output.written.c_str());
    for (const std::string& remains : output.remains) ::unlink(remains.c_str());
  }
}

bool abandon_pending_outputs() noexcept {
  living().lock.lock();
  const auto is_pending = [](const PendingOutputs* outputs) { return !outputs->committed_; };
  if (living().committed && std::ranges::none_of(living().all, is_pending)) {
    living().lock.unlock();
    return false;
  }
  for (const PendingOutputs* outputs : living().all) outputs->remove_written();
  return true;
}

PendingOutputs::Output PendingOutputs::output_of(const std::string& target, Overwrite mode) const {
  if (target.empty()) throw Error(ErrorCode::Usage, "the name of an output is empty; give a path");
  if (target == "-") {
    throw Error(ErrorCode::Usage,
                "'-' is no file: only --report goes to stdout; give a path, or /dev/stdout");
  }
  if (const std::optional<int> descriptor = descriptor_of(target)) {
    return {name_of_descriptor(*descriptor), name_of_descriptor(*descriptor), mode, {}};
  }
  std::error_code ignored;
  const fs::file_status status = fs::status(target, ignored);
  if (fs::is_directory(status)) {
    throw Error(ErrorCode::Usage, target + ": is a folder; give the name of a file in it");
  }
  if (is_stream(target)) return {target, target, mode, {}};
  if (fs::is_block_file(status) || fs::is_socket(status)) {
    throw Error(ErrorCode::Usage, target + ": is a block device or a socket; give the name of a file");
  }
  const fs::path path = behind_links(target);
  const fs::path folder = folder_of(path);
  if (!fs::is_directory(folder, ignored)) {
    throw Error(ErrorCode::NotFound, target + ": there is no folder '" + folder.string() +
                                         "'; create it first, or choose another place");
  }
  if (fs::exists(status) && mode == Overwrite::No) {
    throw exists_already(target);
  }
  refuse_open_database(path.string());
  for (const std::string& source : sources_) {
    if (!fs::equivalent(target, source, ignored)) continue;
    throw Error(ErrorCode::Usage,
                target + ": is a source or a part of one, and would be lost; give the output another name");
  }
  const std::string written = unused_path(path).string();
  return {path.string(), written, mode, remains_of(written)};
}

void PendingOutputs::check_new(const Output& output, const std::vector<Output>& known) {
  const bool shared = !output.is_file() && !descriptor_of(output.target);  // as /dev/null
  for (const Output& other : known) {
    if (shared || other.is_file() != output.is_file()) continue;
    const bool same = output.is_file()
                          ? fs::weakly_canonical(other.target) == fs::weakly_canonical(output.target)
                          : other.target == output.target;
    if (!same) continue;
    throw Error(ErrorCode::Usage, output.target + ": two outputs have this name; give each its own");
  }
}

std::string PendingOutputs::add(const std::string& target, Overwrite mode) {
  const std::scoped_lock lock(living().lock);
  const Output output = output_of(target, mode);
  check_new(output, outputs_);
  outputs_.push_back(output);
  return output.written;
}

void PendingOutputs::plan(const std::string& target, Overwrite mode) {
  const std::scoped_lock lock(living().lock);
  const Output output = output_of(target, mode);
  check_new(output, outputs_);
  check_new(output, planned_);
  planned_.push_back(output);
}

void PendingOutputs::remove_stale(const std::string& target, Overwrite mode) {
  std::error_code ignored;
  if (!fs::exists(fs::symlink_status(target, ignored))) return;
  if (mode == Overwrite::No) {
    throw Error(ErrorCode::OutputExists,
                target +
                    ": would be taken for a part of the output; move it away, choose "
                    "another name, or remove it with --overwrite");
  }
  stale_.push_back(target);
}

void PendingOutputs::commit() {
  for (const Output& output : outputs_) {
    if (!output.is_file()) continue;
    std::error_code ignored;
    const fs::file_status old = fs::status(output.target, ignored);
    if (fs::is_regular_file(old)) fs::permissions(output.written, old.permissions(), ignored);
    sync_to_device(output.written, output.target);
    refuse_open_database(output.target);
  }
  const std::scoped_lock lock(living().lock);
  committed_ = living().committed = true;
  for (const std::string& stale : stale_) ::unlink(stale.c_str());
  for (Output& output : outputs_) {
    if (!output.is_file()) continue;
    if (is_database(output.target)) {
      for (const std::string& remains : remains_of(output.target)) ::unlink(remains.c_str());
    }
    if (!give_name(output.written, output.target, output.mode)) {
      if (errno == EEXIST) throw exists_already(output.target);
      throw Error(ErrorCode::WriteFailed, output.target + ": the finished file cannot be given its name (" +
                                              describe_errno(errno) + ")");
    }
    output.written = output.target;
  }
  for (const Output& output : outputs_) {
    if (fs::is_regular_file(output.target)) sync_to_device(folder_of(output.target), output.target);
  }
  outputs_.clear();
  stale_.clear();
}

}  // namespace thalweg
