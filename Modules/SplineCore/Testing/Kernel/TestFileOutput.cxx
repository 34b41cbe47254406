// SPDX-License-Identifier: BSD-3-Clause
#include <knotwork/SplineCore/FileOutput.h>

#include <gtest/gtest.h>

#include <cerrno>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <system_error>

#include <sys/resource.h>
#include <unistd.h>

namespace fs = std::filesystem;
using namespace knotwork;

namespace
{
/// A folder of its own, and all files in it.
struct Folder
{
  Folder() : Path(fs::temp_directory_path() / ("knotwork-output-" + std::to_string(getpid())))
  {
    fs::create_directory(this->Path);
  }
  ~Folder() { fs::remove_all(this->Path); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::size_t Count() const
  {
    return static_cast<std::size_t>(
      std::distance(fs::directory_iterator(this->Path), fs::directory_iterator()));
  }
  fs::path Path;
};

std::string TextOf(const fs::path& file)
{
  std::ifstream stream(file, std::ios::binary);
  return { std::istreambuf_iterator<char>(stream), {} };
}

Status Write(const fs::path& file, const std::string& text)
{
  FileOutput output(file.string());
  output.Stream() << text;
  return output.Finish();
}

/// Files of this process are at most so large; restored at the end.
struct SizeOfFiles
{
  explicit SizeOfFiles(rlim_t bytes)
  {
    getrlimit(RLIMIT_FSIZE, &this->Before);
    const rlimit limit{ bytes, this->Before.rlim_max };
    setrlimit(RLIMIT_FSIZE, &limit);
    this->Handler = std::signal(SIGXFSZ, SIG_IGN);
  }
  ~SizeOfFiles()
  {
    setrlimit(RLIMIT_FSIZE, &this->Before);
    std::signal(SIGXFSZ, this->Handler);
  }
  SizeOfFiles(const SizeOfFiles&) = delete;
  SizeOfFiles& operator=(const SizeOfFiles&) = delete;
  rlimit Before{};
  void (*Handler)(int) = nullptr;
};
}

TEST(FileOutput, WritesAllBytes_ExactOracle)
{
  const Folder folder;
  std::string text;
  for (int i = 0; i < 100000; ++i)
  {
    text += std::to_string(i) + '\0';
  }
  for (const std::size_t size :
    { std::size_t{ 0 }, std::size_t{ 1 }, std::size_t{ 65536 }, std::size_t{ 65537 }, text.size() })
  {
    ASSERT_TRUE(Write(folder.Path / "file", text.substr(0, size)));
    EXPECT_EQ(TextOf(folder.Path / "file"), text.substr(0, size));
    EXPECT_EQ(folder.Count(), 1U);
  }
}

TEST(FileOutput, WhatIsNotFinishedLeavesNothing)
{
  const Folder folder;
  ASSERT_TRUE(Write(folder.Path / "file", "before"));
  {
    FileOutput output((folder.Path / "file").string());
    output.Stream() << "half of";
    FileOutput other((folder.Path / "new").string());
  }
  EXPECT_EQ(TextOf(folder.Path / "file"), "before");
  EXPECT_EQ(folder.Count(), 1U);
}

TEST(FileOutput, AFullDiskIsTheReasonThatIsGiven)
{
  const std::string full = std::generic_category().message(ENOSPC);
  const Status device = Write("/dev/full", "text");
  EXPECT_EQ(device.Code, ErrorCode::FileError);
  EXPECT_EQ(device.Detail, "'/dev/full' cannot be written: " + full);
  EXPECT_TRUE(fs::exists("/dev/full"));

  const Folder folder;
  ASSERT_TRUE(Write(folder.Path / "file", "before"));
  for (const std::size_t size : { 4097U, 200000U })
  {
    const SizeOfFiles limit(4096);
    const Status status = Write(folder.Path / "file", std::string(size, 'x'));
    EXPECT_NE(status.Detail.find(std::generic_category().message(EFBIG)), std::string::npos)
      << status.Detail;
  }
  EXPECT_EQ(TextOf(folder.Path / "file"), "before");
  EXPECT_EQ(folder.Count(), 1U);
}

TEST(FileOutput, LinksStayAndFilesKeepTheirPermissions)
{
  const Folder folder;
  fs::create_directory(folder.Path / "far");
  ASSERT_TRUE(Write(folder.Path / "far" / "file", "before"));
  fs::permissions(folder.Path / "far" / "file", fs::perms::owner_read | fs::perms::owner_write);
  fs::create_symlink("far/file", folder.Path / "link");
  fs::create_symlink("far/new", folder.Path / "dangling");
  ASSERT_TRUE(Write(folder.Path / "link", "after"));
  ASSERT_TRUE(Write(folder.Path / "dangling", "new"));
  EXPECT_TRUE(fs::is_symlink(folder.Path / "link") && fs::is_symlink(folder.Path / "dangling"));
  EXPECT_EQ(TextOf(folder.Path / "far" / "file"), "after");
  EXPECT_EQ(TextOf(folder.Path / "far" / "new"), "new");
  EXPECT_EQ(fs::status(folder.Path / "far" / "file").permissions(),
    fs::perms::owner_read | fs::perms::owner_write);
}

TEST(FileOutput, AFolderThatIsNotThereIsNamed)
{
  const Status status = Write("/no/such/folder/file", "text");
  EXPECT_EQ(status.Detail,
    "'/no/such/folder/file' cannot be written: " + std::generic_category().message(ENOENT));
}
