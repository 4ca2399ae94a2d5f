// Outputs appear whole or not at all.
#include "write_scene.hpp"

#include <sys/stat.h>

#include <cstdlib>

namespace thalweg {
namespace {

using test::expect_error;
using test::TempFolder;

TEST(PendingOutputs, NothingIsSeenBeforeCommit) {
  const TempFolder folder;
  PendingOutputs pending;
  const std::string written = pending.add(folder.file("a.ply"), Overwrite::No);
  EXPECT_TRUE(folder.names().empty());
  EXPECT_EQ(std::filesystem::path(written).extension(), ".ply");
  EXPECT_EQ(std::filesystem::path(written).parent_path(),
            std::filesystem::path(folder.file("x")).parent_path());
  test::write_text(written, "whole");
  EXPECT_FALSE(std::filesystem::exists(folder.file("a.ply")));
  pending.commit();
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ply"});
  EXPECT_EQ(test::read_text(folder.file("a.ply")), "whole");
}

TEST(PendingOutputs, WhatIsNotCommittedIsRemoved) {
  const TempFolder folder;
  test::write_text(folder.file("old"), "old");
  {
    PendingOutputs pending;
    const std::string written = pending.add(folder.file("new.gpkg"), Overwrite::No);
    test::write_text(written, "part");
    test::write_text(written + "-journal", "part");
    test::write_text(pending.add(folder.file("old"), Overwrite::Yes), "new");
  }
  EXPECT_EQ(folder.names(), std::vector<std::string>{"old"});
  EXPECT_EQ(test::read_text(folder.file("old")), "old");
}

TEST(PendingOutputs, OverwriteKeepsModeAndFollowsLinks) {
  const TempFolder folder;
  test::write_text(folder.file("old"), "old");
  ::chmod(folder.file("old").c_str(), 0640);
  std::filesystem::create_symlink("old", folder.file("link"));
  PendingOutputs pending;
  test::write_text(pending.add(folder.file("link"), Overwrite::Yes), "new");
  pending.commit();
  EXPECT_TRUE(std::filesystem::is_symlink(folder.file("link")));
  EXPECT_EQ(test::read_text(folder.file("old")), "new");
  struct stat status {};
  ASSERT_EQ(::stat(folder.file("old").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 0777U, 0640U);
}

TEST(PendingOutputs, RefusalsNameTheRemedy) {
  const TempFolder folder;
  test::write_text(folder.file("old"), "old");
  PendingOutputs pending;
  expect_error(ErrorCode::OutputExists, {"old", "--overwrite"},
               [&] { pending.add(folder.file("old"), Overwrite::No); });
  expect_error(ErrorCode::NotFound, {"no folder", "missing", "create"},
               [&] { pending.add(folder.file("missing/a.ply"), Overwrite::No); });
  expect_error(ErrorCode::NotFound, {"no folder"},
               [&] { pending.add(folder.file("old/a.ply"), Overwrite::No); });
  expect_error(ErrorCode::Usage, {"folder"}, [&] { pending.add(folder.file(""), Overwrite::Yes); });
  expect_error(ErrorCode::Usage, {"empty"}, [&] { pending.add("", Overwrite::Yes); });
  expect_error(ErrorCode::WriteFailed, {"/proc", "cannot be written"},
               [&] { pending.add("/proc/a.ply", Overwrite::No); });
  pending.add(folder.file("a"), Overwrite::No);
  expect_error(ErrorCode::Usage, {"two outputs"}, [&] { pending.add(folder.file("./a"), Overwrite::No); });
}

TEST(PendingOutputs, DevicesAreWrittenDirectly) {
  {
    PendingOutputs pending;
    EXPECT_EQ(pending.add("/dev/null", Overwrite::No), "/dev/null");
    pending.commit();
  }
  EXPECT_TRUE(std::filesystem::is_character_file("/dev/null"));
}

// In a process of its own, which ends with 0 if all is as told.
[[noreturn]] void abandon_after_commit(const std::string& done, const std::string& left) {
  {
    PendingOutputs first;
    test::write_text(first.add(done, Overwrite::No), "whole");
    first.commit();
  }
  PendingOutputs second;
  const std::string written = second.add(left, Overwrite::No);
  test::write_text(written, "part");
  test::write_text(written + "-wal", "part");
  std::_Exit(abandon_pending_outputs() ? 0 : 1);
}

TEST(PendingOutputs, AbandonedAfterACommit) {
  const TempFolder folder;
  EXPECT_EXIT(abandon_after_commit(folder.file("a.ply"), folder.file("b.gpkg")), testing::ExitedWithCode(0),
              "");
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ply"});
}

TEST(PendingOutputs, NothingIsLeftToAbandonOnceAllIsCommitted) {
  const TempFolder folder;
  PendingOutputs pending;
  test::write_text(pending.add(folder.file("a.ply"), Overwrite::No), "whole");
  pending.commit();
  EXPECT_FALSE(abandon_pending_outputs());
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.ply"});
}

TEST(PendingOutputs, StaleFilesGoAtCommitOnly) {
  const TempFolder folder;
  test::write_text(folder.file("a.prj"), "stale");
  PendingOutputs pending;
  pending.remove_stale(folder.file("none.prj"), Overwrite::No);
  expect_error(ErrorCode::OutputExists, {"a.prj"},
               [&] { pending.remove_stale(folder.file("a.prj"), Overwrite::No); });
  pending.remove_stale(folder.file("a.prj"), Overwrite::Yes);
  EXPECT_EQ(folder.names().size(), 1U);
  pending.commit();
  EXPECT_TRUE(folder.names().empty());
}

}  // namespace
}  // namespace thalweg
