// SPDX-License-Identifier: BSD-3-Clause
// Oracle: programs of the shell, whose ends are known.
#include <knotwork/SplineGrid/WorkerProcess.h>

#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <numeric>

namespace fs = std::filesystem;

namespace
{
using namespace knotwork;

WorkerLimits Seconds(int seconds)
{
  WorkerLimits limits;
  limits.Seconds = seconds;
  return limits;
}

/// A worker of the shell while it lives.
class ShellWorker
{
public:
  explicit ShellWorker(const std::string& commands)
  {
    std::ofstream(this->Folder.Path() + "/worker") << "#!/bin/bash\n" << commands << "\n";
    fs::permissions(this->Folder.Path() + "/worker", fs::perms::owner_all);
    setenv("KNOTWORK_WORKERS", this->Folder.Path().c_str(), 1);
  }
  ~ShellWorker() { unsetenv("KNOTWORK_WORKERS"); }
  ShellWorker(const ShellWorker&) = delete;
  ShellWorker& operator=(const ShellWorker&) = delete;

private:
  TemporaryFolder Folder;
};

ProgramAnswer Shell(const std::string& commands, const WorkerLimits& limits = Seconds(60))
{
  const TemporaryFolder folder;
  return RunForeignProgram("sh", { "-c", commands }, folder.Path(), limits);
}
}

TEST(WorkerProcess, PartsGoBothWays)
{
  // takes all before it answers: an error code of 0, no detail, and what it got, with its end
  const ShellWorker worker("head -c 3000024 <&3 > \"$0.input\"\n"
                           "printf '\\001\\0\\0\\0\\0\\0\\0\\0000' >&3\n"
                           "printf '\\0\\0\\0\\0\\0\\0\\0\\0' >&3\n"
                           "cat \"$0.input\" >&3");
  std::string large(3000000, '\0');
  std::iota(large.begin(), large.end(), 1);
  const WorkerAnswer answer = RunWorker("worker", {}, { large, "" }, Seconds(60));
  ASSERT_EQ(answer.End, WorkerEnd::Done);
  EXPECT_TRUE(answer.Outcome);
  ASSERT_EQ(answer.Parts.size(), 2u);
  EXPECT_EQ(answer.Parts[0], large);
  EXPECT_EQ(answer.Parts[1], "");
}

TEST(WorkerProcess, AnyEndOfAWorkerIsSaid)
{
  const struct
  {
    const char* Commands;
    WorkerEnd End;
  } cases[] = { { "kill -SEGV $$", WorkerEnd::Crashed }, { "exit 0", WorkerEnd::Crashed },
    { "exit 3", WorkerEnd::OutOfMemory }, { "kill -XCPU $$", WorkerEnd::Late },
    { "sleep 30", WorkerEnd::Late } };
  for (const auto& c : cases)
  {
    SCOPED_TRACE(c.Commands);
    const ShellWorker worker(c.Commands);
    EXPECT_EQ(RunWorker("worker", {}, { std::string(5000000, 'x') }, Seconds(2)).End, c.End);
  }
  const ShellWorker worker("exit 0");
  EXPECT_EQ(RunWorker("no_such_worker", {}, {}, Seconds(2)).End, WorkerEnd::Missing);
}

TEST(WorkerProcess, WhatTheCallerDoesNotWantAnyMoreEnds)
{
  const ShellWorker worker("sleep 30");
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_EQ(RunWorker("worker", {}, {}, Seconds(25), [] { return false; }).End, WorkerEnd::Aborted);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(20));
}

TEST(WorkerProcess, AProgramWorksInItsFolder)
{
  const TemporaryFolder folder;
  const ProgramAnswer answer = RunForeignProgram("sh",
    { "-c", "pwd > place; echo $HOME >> place; echo out; echo err >&2; exit 7" }, folder.Path(),
    Seconds(60));
  EXPECT_EQ(answer.End, WorkerEnd::Done);
  EXPECT_EQ(answer.ExitStatus, 7);
  EXPECT_EQ(answer.Printed, "out\nerr\n");
  std::string first;
  std::string second;
  std::ifstream(folder.Path() + "/place") >> first >> second;
  EXPECT_EQ(first, fs::canonical(folder.Path()).string());
  EXPECT_EQ(second, folder.Path());
}

TEST(WorkerProcess, AnyEndOfAProgramIsSaid)
{
  EXPECT_EQ(Shell("kill -SEGV $$").End, WorkerEnd::Crashed);
  EXPECT_EQ(Shell("sleep 30", Seconds(1)).End, WorkerEnd::Late);
  // what it has started ends with it, so that nothing keeps its output open
  EXPECT_EQ(Shell("sleep 30 & sleep 30", Seconds(1)).End, WorkerEnd::Late);
  const TemporaryFolder folder;
  EXPECT_EQ(
    RunForeignProgram("no_such_program", {}, folder.Path(), Seconds(1)).End, WorkerEnd::Missing);
  EXPECT_EQ(RunForeignProgram("sh", {}, "/no/such/folder", Seconds(1)).End, WorkerEnd::NotStarted);
  WorkerLimits few = Seconds(60);
  few.CpuSeconds = 1;
  EXPECT_EQ(Shell("while :; do :; done", few).End, WorkerEnd::Late);
  few = Seconds(60);
  few.Memory = 1 << 20U; // of a file, too
  EXPECT_NE(Shell("head -c 2000000 /dev/zero > file", few).ExitStatus, 0);
}

TEST(WorkerProcess, OnlyTheEndOfWhatIsPrintedIsKept)
{
  const ProgramAnswer answer = Shell("seq 100000");
  ASSERT_EQ(answer.End, WorkerEnd::Done);
  EXPECT_EQ(answer.Printed.size(), 65536u);
  EXPECT_EQ(answer.Printed.substr(65536 - 13), "99999\n100000\n");
}

TEST(WorkerProcess, ATemporaryFolderLeavesNothing)
{
  std::string path;
  {
    const TemporaryFolder folder;
    path = folder.Path();
    ASSERT_TRUE(fs::is_directory(path));
    std::ofstream(path + "/file") << "x";
  }
  EXPECT_FALSE(fs::exists(path));
}
