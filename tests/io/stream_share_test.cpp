/// Several tasks that bend one PLY into one output.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <numeric>
#include <random>
#include <thread>

#include "engine/io/shared_file.h"
#include "engine/io/stream.h"
#include "tests/io/file_checks.h"
#include "tests/io/stream_fixtures.h"
#include "tests/io/temporary_folder.h"

namespace sinew::io {

namespace {

const Vec3 origin(5400000, 0, 0);

StreamOptions task(std::uint64_t index, std::uint64_t count, bool force = false) {
  StreamOptions options;
  options.origin = origin;
  options.force = force;
  options.share = Share{index, count};
  return options;
}

/// A folder with in.ply and what one run makes of it.
struct Bent {
  TemporaryFolder folder;
  std::string in = folder / "in.ply", out = folder / "out.ply", text, wanted;

  explicit Bent(std::size_t n, const char* encoding = "binary_little_endian") : text(made(made_ply(encoding, n))) {
    save_bytes(in, bytes_of(text), false);
    StreamOptions options;
    options.origin = origin;
    stream(in, folder / "single.ply", options, bend);
    wanted = text_of_file(folder / "single.ply");
  }
  std::string refused(const StreamOptions& options) const {
    return sentence_of([&] { stream(in, out, options, bend); });
  }
};

}  // namespace

TEST(Share, TilesAnyNumber) {
  for (const std::uint64_t n :
       {std::uint64_t{0}, std::uint64_t{5}, std::uint64_t{64}, std::uint64_t{1000000007}, ~std::uint64_t{0}})
    for (const std::uint64_t count : {1u, 2u, 3u, 7u, 64u, 4294967295u}) {
      EXPECT_EQ((Share{1, count}.first(n)), 0u);
      EXPECT_EQ((Share{count, count}.last(n)), n);
      for (const std::uint64_t index : {std::uint64_t{1}, (count + 1) / 2, count - 1}) {
        if (index < 1 || index >= count) continue;
        EXPECT_EQ((Share{index, count}.last(n)), (Share{index + 1, count}.first(n)));
        const std::uint64_t size = Share{index, count}.last(n) - Share{index, count}.first(n);
        EXPECT_GE(size, n / count);
        EXPECT_LE(size, n / count + 1);
      }
    }
}

TEST(StreamShare, TasksInAnyOrderGiveTheBytesOfOneRun) {
  for (const char* encoding : {"binary_little_endian", "binary_big_endian"}) {
    const Bent bent(5000, encoding);
    for (const std::uint64_t count : {1u, 2u, 3u, 7u, 64u}) {
      std::vector<std::uint64_t> order(count);
      std::iota(order.begin(), order.end(), 1);
      std::shuffle(order.begin(), order.end(), std::mt19937(static_cast<unsigned>(count)));
      std::filesystem::remove(bent.out);
      std::size_t points = 0;
      for (const std::uint64_t index : order) {
        stream(bent.in, bent.out, task(index, count), [&](Shape& block) {
          points += block.size();
          bend(block);
        });
        EXPECT_EQ(std::filesystem::file_size(bent.out), bent.text.size());
      }
      EXPECT_EQ(points, 5000u);
      EXPECT_TRUE(text_of_file(bent.out) == bent.wanted) << encoding << ' ' << count;
    }
  }
}

TEST(StreamShare, ATaskWritesItsShareOnly) {
  const Bent bent(1000);
  const std::size_t header = bent.text.find("end_header\n") + 11, points = header + 12;
  for (const std::uint64_t index : {1u, 2u, 3u}) {
    std::filesystem::remove(bent.out);
    stream(bent.in, bent.out, task(index, 3), bend);
    std::string wanted(bent.text.size(), '\0');
    const std::size_t begin = index == 1 ? 0 : points + 32 * (1000 * (index - 1) / 3);
    const std::size_t end = index == 3 ? bent.text.size() : points + 32 * (1000 * index / 3);
    wanted.replace(0, header, bent.wanted, 0, header);
    wanted.replace(begin, end - begin, bent.wanted, begin, end - begin);
    EXPECT_TRUE(text_of_file(bent.out) == wanted) << index;
  }
}

TEST(StreamShare, MoreTasksThanPoints) {
  for (const std::size_t n : {std::size_t{1}, std::size_t{2}}) {
    const Bent bent(n);
    for (const std::uint64_t index : {3u, 1u, 5u, 2u, 4u}) stream(bent.in, bent.out, task(index, 5), bend);
    EXPECT_TRUE(text_of_file(bent.out) == bent.wanted) << n;
  }
}

TEST(StreamShare, TasksAtOnceGiveTheSame) {
  const Bent bent(200000);
  for (int time = 0; time < 5; ++time) {
    std::filesystem::remove(bent.out);
    std::vector<std::thread> tasks;
    for (std::uint64_t index = 1; index <= 8; ++index)
      tasks.emplace_back([&, index] { stream(bent.in, bent.out, task(index, 8), bend); });
    for (std::thread& thread : tasks) thread.join();
    EXPECT_TRUE(text_of_file(bent.out) == bent.wanted) << time;
  }
}

TEST(StreamShare, ATaskKilledInTheMiddleIsRunAgain) {
  const Bent bent(600000);
  stream(bent.in, bent.out, task(1, 2), bend);
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    int blocks = 0;  // killed before its second block of three is written
    stream(bent.in, bent.out, task(2, 2), [&blocks](Shape& block) {
      if (++blocks == 2) kill(getpid(), SIGKILL);
      bend(block);
    });
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  ASSERT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGKILL);
  EXPECT_FALSE(text_of_file(bent.out) == bent.wanted);
  stream(bent.in, bent.out, task(2, 2), bend);
  EXPECT_TRUE(text_of_file(bent.out) == bent.wanted);
}

TEST(StreamShare, ABillionPointsAreReachedByTheirOffsets) {
  const TemporaryFolder folder;
  constexpr std::uint64_t points = 1'000'000'000, tasks = 100'000;
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
                             "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  const std::string in = folder / "in.ply", out = folder / "out.ply";
  save_bytes(in, bytes_of(header), false);
  std::filesystem::resize_file(in, header.size() + points * 12);  // a hole: zeros without a disk
  for (const std::uint64_t index : {tasks, tasks / 2 + 1})
    stream(in, out, task(index, tasks), [](Shape& block) {
      for (Vec3& p : block.positions) p = Vec3(1, 2, 3) - block.origin;
    });
  EXPECT_EQ(std::filesystem::file_size(out), header.size() + points * 12);
  struct stat status;
  ASSERT_EQ(stat(out.c_str(), &status), 0);
  EXPECT_LT(status.st_blocks, 4096);  // two shares of 10,000 points, and nothing between
  std::ifstream file(out, std::ios::binary);
  const auto point = [&](std::uint64_t i) {
    float p[3] = {-1, -1, -1};
    file.seekg(static_cast<std::streamoff>(header.size() + 12 * i));
    file.read(reinterpret_cast<char*>(p), sizeof(p));
    return Vec3(p[0], p[1], p[2]);
  };
  for (const std::uint64_t i : {points - 1, points - 10000, points / 2, points / 2 + 9999})
    EXPECT_EQ(point(i), Vec3(1, 2, 3)) << i;
  for (const std::uint64_t i : {points - 10001, points / 2 - 1, points / 2 + 10000, std::uint64_t{0}})
    EXPECT_EQ(point(i), Vec3(0, 0, 0)) << i;
}

TEST(StreamShare, AnotherFileUnderTheNameIsRefused) {
  const Bent bent(100);
  const std::string size = std::to_string(bent.text.size());
  const std::string expected =
      bent.out + ": expected a new file, or one of " + size + " bytes that tasks of this output have begun, found ";
  save_bytes(bent.out, bytes_of("old"), true);
  EXPECT_EQ(bent.refused(task(1, 2)), expected + "another one of 3 bytes (--force replaces it)");
  EXPECT_EQ(text_of_file(bent.out), "old");
  const std::string other(bent.text.size(), 'x');
  save_bytes(bent.out, bytes_of(other), true);
  EXPECT_EQ(bent.refused(task(2, 2)), expected + "another one with another header (--force replaces it)");
  EXPECT_EQ(text_of_file(bent.out), other);
  for (const std::string& old : {std::string("old"), other, other + other, std::string()}) {
    save_bytes(bent.out, bytes_of(old), true);
    for (const std::uint64_t index : {2u, 1u}) stream(bent.in, bent.out, task(index, 2, true), bend);
    EXPECT_TRUE(text_of_file(bent.out) == bent.wanted) << old.size();
  }
}

TEST(StreamShare, WhatCannotBeSharedIsRefused) {
  const Bent bent(100);
  const auto refused = [&](const std::string& in, const std::string& out) {
    return sentence_of([&] { stream(in, out, task(1, 2), bend); });
  };
  const std::string in = bent.folder / "other.ply";
  const auto input = [&](const MadePly& ply) {
    save_bytes(in, bytes_of(made(ply)), true);
    return refused(in, bent.out);
  };
  const std::string binary = ": expected a binary PLY without lists up to its points, which tasks can share, found ";
  EXPECT_EQ(input(made_ply("ascii", 10)), in + binary + "a text");
  MadePly lists_first = made_ply("binary_little_endian", 10);
  std::swap(lists_first.elements[0], lists_first.elements[2]);
  EXPECT_EQ(input(lists_first), in + binary + "lists");
  save_bytes(bent.folder / "a.xyz", bytes_of("1 2 3\n"), true);
  EXPECT_EQ(refused(bent.folder / "a.xyz", bent.out), (bent.folder / "a.xyz") + binary + "XYZ");
  EXPECT_EQ(refused(bent.in, bent.folder / "out.xyz"),
            (bent.folder / "out.xyz") + ": expected a PLY as the input is, which tasks can share, found XYZ");

  const std::string whole = bent.text.substr(0, bent.text.size() - 2000);
  save_bytes(in, bytes_of(whole), true);
  const std::size_t data = bent.text.find("end_header\n") + 11 + 12;
  EXPECT_EQ(refused(in, bent.out), in + ": byte " + std::to_string(data) +
                                       ": expected 100 rows of \"vertex\" of 32 bytes, found only " +
                                       std::to_string(whole.size() - data) + " bytes to the end of the file");
  save_bytes(in, bytes_of("ply\nformat binary_little_endian 1.0\n"), true);
  EXPECT_EQ(refused(in, bent.out), in + ":3:1: expected \"end_header\", found the end of the file");
  save_bytes(in, bytes_of("version https://git-lfs.github.com/spec/v1\n"), true);
  EXPECT_EQ(refused(in, bent.out),
            in + ": expected PLY data, found a Git LFS pointer (the file itself was not downloaded)");
  EXPECT_FALSE(std::filesystem::exists(bent.out));
}

TEST(StreamShare, PipesDevicesAndTheInputItselfAreRefused) {
  const Bent bent(100);
  const auto refused = [](const std::string& in, const std::string& out) {
    return sentence_of([&] {
      StreamOptions options = task(1, 2, true);
      options.as = "ply";
      stream(in, out, options, bend);
    });
  };
  const std::string disk = ": expected a file on a disk, which tasks can share, found ";
  const std::string pipe = bent.folder / "pipe.ply", link = bent.folder / "link.ply", hard = bent.folder / "hard.ply";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_EQ(refused(pipe, bent.out), pipe + disk + "a pipe or a device");
  EXPECT_EQ(refused("-", bent.out), "-" + disk + "a pipe or a device");
  EXPECT_EQ(refused(bent.in, pipe), pipe + disk + "a pipe or a device");
  EXPECT_EQ(refused(bent.in, "-"), "-" + disk + "a pipe or a device");
  std::filesystem::create_directory(bent.folder / "folder.ply");
  EXPECT_EQ(refused(bent.in, bent.folder / "folder.ply"), (bent.folder / "folder.ply") + disk + "a folder");
  std::filesystem::create_symlink(bent.in, link);
  std::filesystem::create_hard_link(bent.in, hard);
  for (const std::string& same : {bent.in, link, hard})
    EXPECT_EQ(refused(bent.in, same), same + ": expected another file than the input, found the input itself");
  EXPECT_TRUE(text_of_file(bent.in) == bent.text);
  EXPECT_EQ(refused(bent.folder / "none.ply", bent.out),
            (bent.folder / "none.ply") + ": expected a file that can be read, found \"No such file or directory\"");
  EXPECT_EQ(
      refused(bent.in, bent.folder / "none/out.ply"),
      (bent.folder / "none/out.ply") + ": expected a file that can be written, found \"No such file or directory\"");
}

TEST(StreamShare, AFullDiskIsASentence) {
  const Bent bent(100000);
  const rlimit before = [] {
    rlimit limit;
    getrlimit(RLIMIT_FSIZE, &limit);
    return limit;
  }();
  std::signal(SIGXFSZ, SIG_IGN);
  const rlimit small{100000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const std::string sentence = bent.refused(task(1, 2));
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_EQ(sentence,
            bent.out + ": expected room for " + std::to_string(bent.text.size()) + " bytes, found \"File too large\"");
}

TEST(StreamShare, ProgressAndCancelling) {
  const Bent bent(600000);
  StreamOptions options = task(2, 2);
  std::vector<double> fractions;
  options.progress = [&](double x) {
    fractions.push_back(x);
    return true;
  };
  stream(bent.in, bent.out, options, bend);
  ASSERT_EQ(fractions.size(), 3u);
  EXPECT_NEAR(fractions[0], 131072.0 / 300000, 1e-12);
  EXPECT_EQ(fractions[2], 1.0);
  options.progress = [](double) { return false; };
  EXPECT_THROW(stream(bent.in, bent.out, options, bend), Cancelled);
  stream(bent.in, bent.out, task(1, 2), bend);
  stream(bent.in, bent.out, task(2, 2), bend);
  EXPECT_TRUE(text_of_file(bent.out) == bent.wanted);
}

}  // namespace sinew::io
