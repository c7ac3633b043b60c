// SPDX-License-Identifier: GPL-3.0-or-later
#include "meniscus/io/write_file_atomically.h"

#include "meniscus/io/directory_lock.h"

#include "io_test_helpers.h"
#include "meniscus/io/read_file.h"

#include <sys/resource.h>

#include <csignal>
#include <thread>

namespace meniscus::test {
namespace {

using Names = std::vector<std::string>;

TEST(WriteFileAtomically, ReplacesTheWholeFile) {
  const TemporaryDirectory directory;
  const auto path = directory / "a.csv";
  write_file_atomically(path, "a long first version\n");
  const std::string second("short\0x", 7);
  write_file_atomically(path, second);
  EXPECT_EQ(read_file(path), second);
  write_file_atomically(path, "");
  EXPECT_EQ(read_file(path), "");
  EXPECT_EQ(directory.names(), Names{"a.csv"});
}

TEST(WriteFileAtomically, KeepsPermissionsAndFollowsLinks) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "a", "1");
  std::filesystem::permissions(directory / "a", std::filesystem::perms(0640));
  std::filesystem::create_symlink("a", directory / "link");
  write_file_atomically(directory / "link", "2");
  EXPECT_TRUE(std::filesystem::is_symlink(directory / "link"));
  EXPECT_EQ(read_file(directory / "a"), "2");
  EXPECT_EQ(std::filesystem::status(directory / "a").permissions(), std::filesystem::perms(0640));
  std::filesystem::create_symlink("not_yet", directory / "dangling");
  write_file_atomically(directory / "dangling", "3");
  EXPECT_EQ(read_file(directory / "not_yet"), "3");
  EXPECT_EQ(directory.names(), (Names{"a", "dangling", "link", "not_yet"}));
}

TEST(WriteFileAtomically, AFailureNamesTheFile) {
  const TemporaryDirectory directory;
  for (const auto& path :
       {directory / "no/such/folder.ply", std::filesystem::path("/proc/folder.ply"), std::filesystem::path("/dev/full"),
        directory / "", directory / (std::string(300, 'a') + ".ply")}) {
    const std::string error = file_error([&] { write_file_atomically(path, "text"); });
    EXPECT_EQ(error.substr(0, path.string().size() + 2), path.string() + ": ");
    EXPECT_TRUE(has(error, ";")) << error;
  }
  EXPECT_TRUE(directory.names().empty());
}

/// No file may grow beyond a size while this lives: what a full disk looks like.
class FileSizeLimit {
 public:
  explicit FileSizeLimit(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &old_);
    const rlimit limit{bytes, old_.rlim_max};
    ::setrlimit(RLIMIT_FSIZE, &limit);
  }
  FileSizeLimit(const FileSizeLimit&) = delete;
  FileSizeLimit& operator=(const FileSizeLimit&) = delete;
  ~FileSizeLimit() {
    ::setrlimit(RLIMIT_FSIZE, &old_);
    std::signal(SIGXFSZ, handler_);
  }

 private:
  void (*handler_)(int);
  rlimit old_{};
};

TEST(WriteFileAtomically, AFailureHalfwayKeepsTheOlderFileAndLeavesNoOther) {
  const TemporaryDirectory directory;
  write_file_atomically(directory / "old.ply", "older");
  std::string old_error, new_error;
  {
    const FileSizeLimit limit(1000);
    old_error = file_error([&] { write_file_atomically(directory / "old.ply", std::string(5000, 'x')); });
    new_error = file_error([&] { write_file_atomically(directory / "new.ply", std::string(5000, 'x')); });
  }
  EXPECT_TRUE(has(old_error, "old.ply: cannot be written")) << old_error;
  EXPECT_TRUE(has(new_error, "new.ply: cannot be written")) << new_error;
  EXPECT_EQ(directory.names(), Names{"old.ply"});
  EXPECT_EQ(read_file(directory / "old.ply"), "older");
}

TEST(WriteFileAtomically, AMeshThatIsRefusedLeavesNoFile) {
  const TemporaryDirectory directory;
  MeshData data = tetrahedron();
  data.triangles[0][0] = 99;
  EXPECT_TRUE(has(file_error([&] { write_mesh(directory / "a.off", data); }), "a.off: triangle 0"));
  EXPECT_THROW(write_mesh(directory / "a.xyz", tetrahedron()), UsageError);
  EXPECT_TRUE(directory.names().empty());
}

TEST(WriteFileAtomically, ThreadsThatWriteOneFileLeaveOneVersion) {
  const TemporaryDirectory directory;
  const std::string versions[] = {std::string(20000, 'a'), std::string(30000, 'b')};
  const auto write_often = [&](const std::string& text) {
    for (int i = 0; i < 20; ++i) write_file_atomically(directory / "a", text);
  };
  std::thread other(write_often, versions[0]);
  write_often(versions[1]);
  other.join();
  const std::string last = read_file(directory / "a");
  EXPECT_TRUE(last == versions[0] || last == versions[1]);
  EXPECT_EQ(directory.names(), Names{"a"});
}

TEST(WriteMesh, ABrokenStreamIsAnError) {
  std::ostringstream out;
  out.setstate(std::ios::badbit);
  EXPECT_THROW(write_mesh(out, MeshFormat::off, tetrahedron()), FileError);
}

TEST(AppendToFile, AddsAndNamesTheFileThatIsNotThere) {
  const TemporaryDirectory directory;
  EXPECT_TRUE(has(file_error([&] { append_to_file(directory / "a", "x"); }), "a: cannot be written"));
  write_file_atomically(directory / "a", "one\n");
  append_to_file(directory / "a", "two\n");
  append_to_file(directory / "a", "");
  EXPECT_EQ(read_file(directory / "a"), "one\ntwo\n");
}

TEST(RemoveTemporaryFiles, TakesWhatKilledProgramsLeftAndNothingElse) {
  const TemporaryDirectory directory;
  for (const char* name : {".meniscus-123-0.tmp", ".meniscus-.tmp", "meniscus-1-0.tmp", ".meniscus-1-0.tmpx", "a"})
    write_file_atomically(directory / name, "");
  remove_temporary_files(directory / ".");
  EXPECT_EQ(directory.names(), (Names{".meniscus-.tmp", ".meniscus-1-0.tmpx", "a", "meniscus-1-0.tmp"}));
}

TEST(DirectoryLock, IsHeldByOneAtATime) {
  const TemporaryDirectory directory;
  {
    DirectoryLock first(directory / "out");
    EXPECT_TRUE(has(file_error([&] { DirectoryLock second(directory / "out"); }), "another run"));
    DirectoryLock moved(std::move(first));
    EXPECT_TRUE(has(file_error([&] { DirectoryLock second(directory / "out"); }), "another run"));
  }
  DirectoryLock again(directory / "out");
  write_file_atomically(directory / "file", "");
  EXPECT_TRUE(has(file_error([&] { DirectoryLock on_file(directory / "file"); }), "cannot be made the directory"));
}

}  // namespace
}  // namespace meniscus::test
