// How much memory there is, as Linux tells it: /proc/meminfo, the control groups (version 1 and 2, each with
// all that contain it; the page cache that can be dropped counts as free), and the limits of the process.
#include "base/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>
#include <utility>

namespace thalweg {

namespace {

constexpr std::size_t kUnlimited = std::numeric_limits<std::size_t>::max();

/// The number that follows a word at a line's start.
std::optional<std::size_t> number_after(const std::string& path, const std::string& word) {
  std::ifstream file(path);
  for (std::string first; file >> first;) {
    std::size_t number = 0;
    if (first == word && file >> number) return number;
    file.ignore(std::numeric_limits<std::streamsize>::max(), '\n');
  }
  return std::nullopt;
}

std::optional<std::size_t> number_in(const std::string& path) {
  std::ifstream file(path);
  std::size_t number = 0;
  if (file >> number) return number;
  return std::nullopt;
}

std::size_t difference(std::size_t limit, std::size_t used) {
  return limit > used ? limit - used : 0;
}

struct GroupFiles {
  std::string root, limit, usage, cache;
};

/// What one control group and those that contain it leave.
std::size_t left_by_groups(const GroupFiles& files, std::string group) {
  std::size_t least = kUnlimited;
  while (true) {
    const std::string folder = files.root + group;
    const auto limit = number_in(folder + files.limit), used = number_in(folder + files.usage);
    if (limit && used) {
      const std::size_t cache = number_after(folder + "/memory.stat", files.cache).value_or(0);
      least = std::min(least, difference(*limit, difference(*used, cache)));
    }
    const std::size_t slash = group.find_last_of('/');
    if (slash == std::string::npos) return least;
    group.resize(slash);
  }
}

/// Lines of /proc/self/cgroup are "number:controllers:/path"; version 2 names no controllers.
std::size_t left_by_control_groups() {
  std::size_t least = kUnlimited;
  std::ifstream file("/proc/self/cgroup");
  for (std::string line; std::getline(file, line);) {
    const std::size_t first = line.find(':');
    const std::size_t second = first == std::string::npos ? first : line.find(':', first + 1);
    if (second == std::string::npos) continue;
    const std::string controllers = "," + line.substr(first + 1, second - first - 1) + ",";
    const std::string group = line.substr(second + 1);
    if (controllers == ",,") {
      least = std::min(least, left_by_groups({.root = "/sys/fs/cgroup",
                                              .limit = "/memory.max",
                                              .usage = "/memory.current",
                                              .cache = "inactive_file"},
                                             group));
    } else if (controllers.find(",memory,") != std::string::npos) {
      least = std::min(least, left_by_groups({.root = "/sys/fs/cgroup/memory",
                                              .limit = "/memory.limit_in_bytes",
                                              .usage = "/memory.usage_in_bytes",
                                              .cache = "total_inactive_file"},
                                             group));
    }
  }
  return least;
}

/// /proc/self/statm counts pages: all of the address space first, data sixth.
std::size_t left_by_limit(int resource, int field) {
  rlimit limit{};
  if (getrlimit(static_cast<__rlimit_resource>(resource), &limit) != 0 || limit.rlim_cur == RLIM_INFINITY) {
    return kUnlimited;
  }
  std::ifstream file("/proc/self/statm");
  std::size_t pages = 0;
  for (int i = 0; i < field; ++i) file >> pages;
  return difference(limit.rlim_cur, pages * static_cast<std::size_t>(sysconf(_SC_PAGESIZE)));
}

}  // namespace

MemoryRoom memory_room() {
  constexpr std::size_t kKibibyte = 1024;
  MemoryRoom room{kUnlimited, "the machine"};
  const auto narrow = [&room](std::size_t bytes, const char* by) {
    if (bytes < room.bytes) room = {bytes, by};
  };
  if (const auto available = number_after("/proc/meminfo", "MemAvailable:")) {
    narrow(*available * kKibibyte, "the machine");
  }
  narrow(left_by_control_groups(), "the control group");
  narrow(left_by_limit(RLIMIT_AS, 1), "ulimit -v");
  narrow(left_by_limit(RLIMIT_DATA, 6), "ulimit -d");
  return room;
}

}  // namespace thalweg
