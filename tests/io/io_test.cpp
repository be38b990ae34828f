#include "engine/io/io.h"

#include <sys/stat.h>
#include <unistd.h>

#include <set>

#include "engine/io/output_file.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

const std::string small =
    "ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\nproperty float z\nend_header\n1 2 "
    "3\n";

std::vector<std::string> names_in(const std::filesystem::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) names.push_back(entry.path().filename());
  std::sort(names.begin(), names.end());
  return names;
}

}  // namespace

TEST(Io, EachExtensionHasOneFormat) {
  std::set<std::string> extensions, names;
  for (const Format& format : formats()) {
    EXPECT_TRUE(names.insert(format.name).second) << format.name;
    EXPECT_NE(format.read, nullptr);
    EXPECT_FALSE(format.help.empty());
    for (const std::string& e : format.extensions) EXPECT_TRUE(extensions.insert(e).second) << e;
  }
  EXPECT_EQ(format_of("folder.obj/A.PlY").name, "PLY");
  EXPECT_EQ(format_of("bun.conf").name, "Scan set");
}

TEST(Io, UnknownExtensionsAreRefusedWithTheKnownOnes) {
  const std::string sentence = sentence_of([] { format_of("a.xyzzy"); });
  EXPECT_TRUE(sentence.starts_with("a.xyzzy: expected a name that ends in .ply, .")) << sentence;
  EXPECT_TRUE(sentence.ends_with(", found \".xyzzy\"")) << sentence;
  EXPECT_TRUE(sentence_of([] { format_of("folder.d/a"); }).ends_with(", found no extension"));
}

TEST(Io, MissingFilesAndFoldersAreRefused) {
  const TemporaryFolder folder;
  EXPECT_EQ(sentence_of([&] { read(folder / "no.ply"); }),
            (folder / "no.ply") + ": expected a file that can be read, found \"No such file or directory\"");
  std::filesystem::create_directory(folder / "d.ply");
  EXPECT_EQ(sentence_of([&] { read(folder / "d.ply"); }), (folder / "d.ply") + ": expected a file, found a folder");
  EXPECT_EQ(sentence_of([&] { save_bytes(folder / "d.ply", {}, true); }),
            (folder / "d.ply") + ": expected the name of a file to write, found a folder");
  EXPECT_EQ(sentence_of([&] { save_bytes(folder / "no/a.ply", {}, false); }),
            (folder / "no/a.ply") + ": expected a folder that can be written, found \"No such file or directory\"");
  EXPECT_EQ(sentence_of([&] { read("-"); }), "-: expected the format of the stream, by an extension, found none");
}

TEST(Io, ReadsWhatItWrote) {
  const TemporaryFolder folder;
  for (const std::size_t size : {0, 1, 4095, 4096, 1 << 20, (1 << 20) + 1, 3000000}) {
    std::vector<std::byte> bytes(size);
    for (std::size_t i = 0; i < size; ++i) bytes[i] = static_cast<std::byte>(i * 7);
    save_bytes(folder / "a", bytes, true);
    EXPECT_TRUE(load_bytes(folder / "a") == bytes) << size;
  }
}

TEST(Io, ReadSetsTheOrigin) {
  const TemporaryFolder folder;
  std::string text = small;
  text.replace(text.find("1 2 3"), 5, "5400000 2 3");
  save_bytes(folder / "a.ply", bytes_of(text), false);
  const auto shape = read(folder / "a.ply");
  EXPECT_NE(shape->origin.x(), 0);
  EXPECT_EQ(shape->positions[0].x() + shape->origin.x(), 5400000);
  write(folder / "b.ply", *shape);
  EXPECT_EQ(text_of_file(folder / "b.ply"), text);
}

TEST(Io, AnExistingFileIsReplacedOnlyByForce) {
  const TemporaryFolder folder;
  save_bytes(folder / "a.ply", bytes_of(small), false);
  const auto shape = read(folder / "a.ply");
  save_bytes(folder / "b.ply", bytes_of("old"), false);
  chmod((folder / "b.ply").c_str(), 0640);
  EXPECT_EQ(sentence_of([&] { write(folder / "b.ply", *shape); }),
            (folder / "b.ply") + ": expected the name of a new file, found an existing one (--force replaces it)");
  EXPECT_EQ(text_of_file(folder / "b.ply"), "old");
  write(folder / "b.ply", *shape, true);
  EXPECT_EQ(text_of_file(folder / "b.ply"), small);
  struct stat status {};
  ASSERT_EQ(stat((folder / "b.ply").c_str(), &status), 0);
  EXPECT_EQ(status.st_mode & 07777, 0640u);
  EXPECT_EQ(names_in(folder.path()), (std::vector<std::string>{"a.ply", "b.ply"}));
}

TEST(Io, AnUnfinishedFileLeavesNothing) {
  const TemporaryFolder folder;
  {
    OutputFile out(folder / "a", false);
    out.write(bytes_of("half"));
    EXPECT_EQ(names_in(folder.path()).size(), 1u);
    EXPECT_FALSE(std::filesystem::exists(folder / "a"));
  }
  EXPECT_TRUE(names_in(folder.path()).empty());
}

TEST(Io, AFileThatAppearedMeanwhileIsNotReplaced) {
  const TemporaryFolder folder;
  OutputFile out(folder / "a", false);
  save_bytes(folder / "a", bytes_of("other"), false);
  EXPECT_EQ(sentence_of([&] { out.commit(); }),
            (folder / "a") + ": expected to give the finished file its name, found \"File exists\"");
  EXPECT_EQ(text_of_file(folder / "a"), "other");
}

TEST(Io, ALinkIsFollowed) {
  const TemporaryFolder folder;
  save_bytes(folder / "target", bytes_of("old"), false);
  std::filesystem::create_symlink(folder / "target", folder / "link");
  save_bytes(folder / "link", bytes_of("new"), true);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "link"));
  EXPECT_EQ(text_of_file(folder / "target"), "new");
}

TEST(Io, ALinkToAFileThatIsNotThereYetIsFollowed) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder / "deep");
  std::filesystem::create_symlink("deep/second", folder / "first");
  std::filesystem::create_symlink("target", folder / "deep/second");
  save_bytes(folder / "first", bytes_of("new"), false);
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "first"));
  EXPECT_TRUE(std::filesystem::is_symlink(folder / "deep/second"));
  EXPECT_EQ(text_of_file(folder / "deep/target"), "new");
  std::filesystem::create_symlink("round", folder / "round");
  EXPECT_NE(sentence_of([&] { save_bytes(folder / "round/file", bytes_of("new"), false); }), "");
}

TEST(Io, AReplacedFileKeepsItsOwner) {
  const TemporaryFolder folder;
  save_bytes(folder / "a", bytes_of("old"), false);
  const uid_t owner = getuid() == 0 ? 4321 : getuid();  // only root can give files away
  ASSERT_EQ(chown((folder / "a").c_str(), owner, static_cast<gid_t>(-1)), 0);
  save_bytes(folder / "a", bytes_of("new"), true);
  struct stat status {};
  ASSERT_EQ(stat((folder / "a").c_str(), &status), 0);
  EXPECT_EQ(status.st_uid, owner);
  EXPECT_EQ(text_of_file(folder / "a"), "new");
}

TEST(Io, StandardInputAndOutput) {
  const TemporaryFolder folder;
  save_bytes(folder / "a.ply", bytes_of(small), false);
  const int in = dup(STDIN_FILENO), out = dup(STDOUT_FILENO);
  ASSERT_NE(freopen((folder / "a.ply").c_str(), "rb", stdin), nullptr);
  const auto shape = read("-", {}, "ply");
  fflush(stdout);
  ASSERT_NE(freopen((folder / "b.ply").c_str(), "wb", stdout), nullptr);
  write("-", *shape, false, "ply");
  fflush(stdout);
  dup2(in, STDIN_FILENO);
  dup2(out, STDOUT_FILENO);
  close(in);
  close(out);
  EXPECT_EQ(text_of_file(folder / "b.ply"), small);
}

TEST(Io, AFullDeviceIsReported) {
  if (!std::filesystem::exists("/dev/full")) GTEST_SKIP() << "no /dev/full";
  EXPECT_EQ(sentence_of([] { save_bytes("/dev/full", bytes_of("x"), false); }),
            "/dev/full: expected room for 1 more bytes, found \"No space left on device\"");
}

TEST(Io, AGitLfsPointerIsNamed) {
  const TemporaryFolder folder;
  save_bytes(folder / "a.stl", bytes_of("version https://git-lfs.github.com/spec/v1\noid sha256:0\nsize 1\n"), false);
  EXPECT_EQ(sentence_of([&] { read(folder / "a.stl"); }),
            (folder / "a.stl") + ": expected STL data, found a Git LFS pointer (the file itself was not downloaded)");
}

}  // namespace sinew::io
