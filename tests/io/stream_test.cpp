#include "engine/io/stream.h"

#include <sys/resource.h>
#include <sys/stat.h>

#include <fstream>
#include <thread>

#include "engine/io/ply.h"
#include "tests/io/file_checks.h"
#include "tests/io/stream_fixtures.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

std::string whole(const std::string& text, const Vec3& origin) {
  Shape shape = read_ply("whole", bytes_of(text), {});
  shape.origin = origin;
  for (Vec3& p : shape.positions) p -= origin;
  bend(shape);
  return write_text(write_ply, shape);
}

long peak_kilobytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return usage.ru_maxrss;
}

}  // namespace

TEST(Stream, GivesWhatReadingAllGives) {
  const TemporaryFolder folder;
  const Vec3 origin(5400000, 0, 0);
  for (const char* encoding : {"ascii", "binary_little_endian", "binary_big_endian"})
    for (const std::size_t n : {std::size_t{2}, std::size_t{1000}, (std::size_t{1} << 17) + 3}) {
      const std::string text = made(made_ply(encoding, n));
      save_bytes(folder / "in.ply", bytes_of(text), true);
      std::size_t points = 0, blocks = 0;
      StreamOptions options;
      options.origin = origin;
      options.force = true;
      stream(folder / "in.ply", folder / "out.ply", options, [&](Shape& block) {
        expect_sound(block, "block");
        EXPECT_EQ(block.origin, origin);
        points += block.size();
        ++blocks;
        bend(block);
      });
      EXPECT_EQ(points, n);
      EXPECT_EQ(blocks, encoding == std::string("ascii") || n < 2000 ? 1u : 2u);
      const std::string out = text_of_file(folder / "out.ply");
      EXPECT_TRUE(out == whole(text, origin)) << encoding << ' ' << n;
      EXPECT_EQ(out == text, false);
    }
}

TEST(Stream, FilesThatCannotBeStreamedComeWhole) {
  const TemporaryFolder folder;
  MadePly lists_first = made_ply("binary_little_endian", 10);
  std::swap(lists_first.elements[0], lists_first.elements[2]);
  MadePly with_list = made_ply("binary_little_endian", 10);
  with_list.elements[1].properties.push_back({"list uchar int", "l", std::vector<std::vector<double>>(10, {1, 2})});
  StreamOptions options;
  options.force = true;
  for (const MadePly& ply : {lists_first, with_list}) {
    save_bytes(folder / "in.ply", bytes_of(made(ply)), true);
    stream(folder / "in.ply", folder / "out.ply", options, bend);
    EXPECT_TRUE(text_of_file(folder / "out.ply") == whole(made(ply), Vec3::Zero()));
  }
  save_bytes(folder / "a.obj", bytes_of("v 3 0 0\nv 1 0.50 0\n"), true);
  stream(folder / "a.obj", folder / "b.obj", options, bend);
  EXPECT_EQ(text_of_file(folder / "b.obj"), "v 3.25 -0.5 0.125\nv 1 0.50 0\n");
  stream(folder / "a.obj", folder / "b.ply", options, bend);
  EXPECT_EQ(read(folder / "b.ply")->size(), 2u);
}

TEST(Stream, PipesAreStreamedToo) {
  const TemporaryFolder folder;
  const std::string text = made(made_ply("binary_little_endian", 300000)), pipe = folder / "pipe.ply";
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::thread writer([&] { std::ofstream(pipe, std::ios::binary) << text; });
  stream(pipe, folder / "out.ply", {}, bend);
  writer.join();
  EXPECT_TRUE(text_of_file(folder / "out.ply") == whole(text, Vec3::Zero()));
  std::thread cut([&] { std::ofstream(pipe, std::ios::binary) << text.substr(0, text.size() - 5000); });
  StreamOptions options;
  options.force = true;
  const std::string sentence = sentence_of([&] { stream(pipe, folder / "out.ply", options, bend); });
  cut.join();
  EXPECT_TRUE(sentence.starts_with(pipe + ": byte ")) << sentence;
  EXPECT_TRUE(
      sentence.ends_with(": expected 300000 rows of \"vertex\" of 32 bytes, found only 0 bytes to the end of the file"))
      << sentence;
}

TEST(Stream, NothingIsWrittenWhereItFails) {
  const TemporaryFolder folder;
  const std::string text = made(made_ply("binary_little_endian", 200000));
  save_bytes(folder / "in.ply", bytes_of(text), false);
  save_bytes(folder / "out.ply", bytes_of("old"), false);
  StreamOptions options;
  EXPECT_EQ(sentence_of([&] { stream(folder / "in.ply", folder / "out.ply", options, bend); }),
            (folder / "out.ply") + ": expected the name of a new file, found an existing one (--force replaces it)");
  options.force = true;
  double last = 0;
  options.progress = [&last](double x) {
    last = x;
    return false;
  };
  EXPECT_THROW(stream(folder / "in.ply", folder / "out.ply", options, bend), Cancelled);
  EXPECT_NEAR(last, 131072.0 / 200000, 1e-12);
  options.progress = nullptr;
  save_bytes(folder / "in.ply", bytes_of(text.substr(0, 3000000)), true);
  const std::size_t data = text.find("end_header\n") + 11 + 12;
  EXPECT_EQ(sentence_of([&] { stream(folder / "in.ply", folder / "out.ply", options, bend); }),
            (folder / "in.ply") + ": byte " + std::to_string(data) +
                ": expected 200000 rows of \"vertex\" of 32 bytes, found only " + std::to_string(3000000 - data) +
                " bytes to the end of the file");
  save_bytes(folder / "in.ply", bytes_of("ply\nformat binary_little_endian 1.0\n"), true);
  EXPECT_EQ(sentence_of([&] { stream(folder / "in.ply", folder / "out.ply", options, bend); }),
            (folder / "in.ply") + ":3:1: expected \"end_header\", found the end of the file");
  EXPECT_EQ(text_of_file(folder / "out.ply"), "old");
  EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder.path()), {}), 2);
}

TEST(Stream, MemoryDoesNotGrowWithTheFile) {
#ifdef SINEW_SANITIZED
  GTEST_SKIP() << "sanitizers keep freed memory";
#endif
  const TemporaryFolder folder;
  constexpr std::size_t points = 20000000;
  const std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " + std::to_string(points) +
                             "\nproperty float x\nproperty float y\nproperty float z\nend_header\n";
  save_bytes(folder / "in.ply", bytes_of(header), false);
  std::filesystem::resize_file(folder / "in.ply", header.size() + points * 12);  // a hole: zeros without a disk
  std::filesystem::create_symlink("/dev/null", folder / "out.ply");
  const long before = peak_kilobytes();
  std::size_t seen = 0;
  stream(folder / "in.ply", folder / "out.ply", {}, [&seen](Shape& block) { seen += block.size(); });
  EXPECT_EQ(seen, points);
  EXPECT_LT(peak_kilobytes() - before, 64 * 1024);
}

TEST(Stream, RealFilesThatAreNotBentComeBackByteForByte) {
  for (const char* name : {"scans/meshlab_rangemaps/lato000.ply", "splats/inria_format/point_cloud.ply",
                           "meshes/elephant.ply", "scans/stanford_bunny/bun000.ply", "soups/soup.stl"}) {
    SHARED_DATA(path, name);
    const TemporaryFolder folder;
    const std::string out = folder / path.filename().string();
    StreamOptions options;
    options.origin = Vec3(1234.5678, -1, 1e-3);
    stream(path.string(), out, options, [](Shape&) {});
    EXPECT_TRUE(text_of_file(out) == text_of_file(path.string())) << name;
  }
}

}  // namespace sinew::io
