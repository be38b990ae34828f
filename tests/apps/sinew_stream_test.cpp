/// Ctrl-C, and files that do not fit into memory.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "tests/apps/program.h"
#include "tests/apps/sinew_fixtures.h"
#include "tests/io/temporary_folder.h"

namespace sinew {

namespace {

/// A binary PLY of n points at the origin whose values take no room on the disk.
void save_sparse_ply(const std::string& path, std::uintmax_t n) {
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(n) +
                             "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  save(path, header);
  std::filesystem::resize_file(path, header.size() + 12 * n);
}

/// The sheet's scan, its edit and its pose in a folder.
struct Solved {
  TemporaryFolder folder;
  std::string pose = folder / "pose.json";

  Solved() {
    save(folder / "scan.ply", sheet_ply());
    save(folder / "edit.json", turn_edit());
    EXPECT_EQ(run_sinew({"deform", folder / "scan.ply", "--edit", folder / "edit.json", "-o", folder / "out.ply",
                         "--pose", pose})
                  .status,
              0);
  }
  std::size_t files() const {
    const std::filesystem::directory_iterator begin(folder.path()), end;
    return static_cast<std::size_t>(std::distance(begin, end));
  }
};

}  // namespace

TEST(SinewInterrupt, EndsAtOnceWhileReading) {
  Program program({"info", "-", "--from", "ply"});
  program.write("ply\n");
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  program.interrupt();
  EXPECT_EQ(program.wait().status, 130);
}

TEST(SinewInterrupt, InTheMiddleOfAFileLeavesNothing) {
  const Solved solved;
  save_sparse_ply(solved.folder / "big.ply", 20'000'000);
  const std::size_t before = solved.files();
  Program program({"apply", solved.pose, solved.folder / "big.ply", "-o", solved.folder / "bent.ply"});
  for (int i = 0; i < 1000 && solved.files() == before; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
  EXPECT_EQ(solved.files(), before + 1);  // the temporary file: it is in the middle
  program.interrupt();
  EXPECT_EQ(program.wait().status, 130);
  EXPECT_EQ(solved.files(), before);
}

TEST(SinewApply, MemoryDoesNotGrowWithTheFile) {
#ifdef SINEW_SANITIZED
  GTEST_SKIP() << "a sanitizer keeps memory that the program has given back";
#endif
  const Solved solved;
  save_sparse_ply(solved.folder / "small.ply", 500'000);
  save_sparse_ply(solved.folder / "big.ply", 4'000'000);
  const auto peak = [&](const char* name) {
    const std::string out = solved.folder / (std::string("bent-") + name);
    const Outcome outcome = run_sinew({"apply", solved.pose, solved.folder / name, "-o", out});
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(std::filesystem::file_size(out), std::filesystem::file_size(solved.folder / name));
    return outcome.peak_kib;
  };
  const long small = peak("small.ply"), big = peak("big.ply");
  EXPECT_LT(big, small + 20 * 1024);
  EXPECT_LT(big, 512 * 1024);
}

}  // namespace sinew
