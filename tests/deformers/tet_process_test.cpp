/// What becomes of sinew-tets ends in a sentence, and nothing of it is left: scripts stand in for it (SINEW_TETS).

#include "deformers/tet_process.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>
#include <sstream>
#include <thread>

#include "deformers/tet_mesh.h"
#include "engine/geometry/error.h"
#include "engine/geometry/random.h"
#include "tests/deformers/tet_shapes.h"

namespace sinew {

namespace {

namespace fs = std::filesystem;

/// Sleeps long; its argument tells it from others' sleeps.
std::string sleep_command() {
  return "sleep 1000." + std::to_string(getpid());
}

/// Processes that this one started, or that those started to sleep, and that run.
std::vector<std::string> running() {
  std::vector<std::string> left;
  for (const auto& entry : fs::directory_iterator("/proc")) {
    std::ifstream file(entry.path() / "stat");
    std::string pid, name, state, parent, command;
    if (!(file >> pid >> name >> state >> parent) || state == "Z") continue;
    std::ifstream(entry.path() / "cmdline") >> command;
    std::replace(command.begin(), command.end(), '\0', ' ');
    if (parent == std::to_string(getpid()) || command.starts_with(sleep_command())) left.push_back(pid + " " + command);
  }
  return left;
}

/// Those that still run after a second: a signal needs a moment.
std::vector<std::string> processes_left() {
  for (int k = 0; k < 100 && !running().empty(); ++k) std::this_thread::sleep_for(std::chrono::milliseconds(10));
  return running();
}

std::size_t open_files() {
  return static_cast<std::size_t>(std::distance(fs::directory_iterator("/proc/self/fd"), fs::directory_iterator()));
}

/// A script that stands in for sinew-tets for as long as this lives.
class Planted {
 public:
  explicit Planted(const std::string& commands, const std::string& reply = "") {
    folder_ = fs::temp_directory_path() / ("sinew-planted-" + std::to_string(getpid()));
    fs::create_directories(folder_);
    std::ofstream(folder_ / "reply", std::ios::binary) << reply;
    std::ofstream(folder_ / "tets") << "#!/bin/sh\ncd '" << folder_.string() << "'\n" << commands << "\n";
    chmod((folder_ / "tets").c_str(), 0700);
    setenv("SINEW_TETS", (folder_ / "tets").c_str(), 1);
  }
  Planted(const Planted&) = delete;
  Planted& operator=(const Planted&) = delete;
  ~Planted() {
    unsetenv("SINEW_TETS");
    fs::remove_all(folder_);
  }

 private:
  fs::path folder_;
};

/// A reply as sinew-tets writes it: the five tets of a box, changed by a test.
struct Reply {
  tets::Reply head;
  std::vector<Vec3> added;
  std::vector<Tet> tets{{0, 1, 2, 4}, {1, 3, 2, 7}, {1, 2, 4, 7}, {1, 4, 5, 7}, {2, 4, 7, 6}};
  std::vector<Index> regions{1, 1, 1, 1, 1};
  std::vector<Index> crossing;

  std::string text() {
    head.added = added.size();
    head.tets = tets.size();
    head.crossing = crossing.size();
    std::string text;
    const auto append = [&text](const void* values, std::size_t bytes) {
      text.append(static_cast<const char*>(values), bytes);
    };
    append(&head, sizeof(head));
    append(added.data(), added.size() * sizeof(Vec3));
    append(tets.data(), tets.size() * sizeof(Tet));
    append(regions.data(), regions.size() * sizeof(Index));
    append(crossing.data(), crossing.size() * sizeof(Index));
    return text;
  }
};

/// The box as five tets wants its sides cut so.
Shape cut_box() {
  Shape shape = box();
  shape.faces = {};
  for (const auto& [a, b, c, d] : Reply().tets)
    for (const Triangle& side : {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{a, d, c}, Triangle{b, c, d}}) {
      const Triangle inner[] = {{1, 2, 4}, {1, 2, 7}, {1, 4, 7}, {2, 4, 7}};
      Triangle sorted = side;
      std::sort(sorted.begin(), sorted.end());
      if (std::find(std::begin(inner), std::end(inner), sorted) == std::end(inner)) shape.faces.add(side);
    }
  return shape;
}

std::string outcome(double seconds = 20) {
  std::vector<std::string> notes;
  TetMeshOptions options;
  options.max_seconds = seconds;
  try {
    return std::to_string(tetrahedralized(cut_box(), options, notes)->tets.size()) + " tets";
  } catch (const InputError& error) {
    return error.what();
  }
}

struct Row {
  const char* name;
  std::string commands;
  std::string reply;
  std::string sentence;
};

std::vector<Row> planted() {
  const std::string good = Reply().text(), give = "cat > /dev/null; exec cat reply";
  const auto changed = [](const std::function<void(Reply&)>& change) {
    Reply reply;
    change(reply);
    return reply.text();
  };
  const auto lying = [&](std::uint64_t added, std::uint64_t count, std::uint64_t crossing) {
    tets::Reply head;
    head.added = added;
    head.tets = count;
    head.crossing = crossing;
    return std::string(reinterpret_cast<const char*>(&head), sizeof(head));
  };
  const std::uint64_t huge = ~std::uint64_t{0};
  return {
      {"crashes", "kill -SEGV $$", "", "found that it was ended by SIGSEGV"},
      {"aborts having read", "cat > /dev/null; kill -ABRT $$", "", "found that it was ended by SIGABRT"},
      {"is killed for memory", "kill -KILL $$", "", "MiB of memory"},
      {"is ended for time", "kill -XCPU $$", "", "within 20 seconds"},
      {"ends with a status", "exit 1", "", "found that it ended with status 1"},
      {"says that TetGen gave up", "exit 12", "", "found that TetGen gave up"},
      {"says that its memory is short", "exit 11", "", "MiB of memory"},
      {"says that it was asked wrongly", "exit 2", "", "does not take what this one asks"},
      {"says nothing", "exit 0", "", "an answer of 0 bytes"},
      {"says nothing having read", "cat > /dev/null", "", "an answer of 0 bytes"},
      {"says little", "printf 12345; exit 0", "", "an answer of 5 bytes"},
      {"leaves another behind", sleep_command() + " & exit 0", "", "an answer of 0 bytes"},
      {"says garbage", "exec yes", "", "an answer that it does not give"},
      {"says zeros", "exec cat /dev/zero", "", "an answer that it does not give"},
      {"goes on and on", "cat reply /dev/zero", good, "an answer longer than it says"},
      {"says its request", "exec cat", "", "an answer that it does not give"},
      {"ends early", give, good.substr(0, good.size() - 1), "an answer that ends early"},
      {"promises all vertices", give, lying(huge, 0, 0), "longer than the memory"},
      {"promises all tets", give, lying(0, huge, 0), "longer than the memory"},
      {"promises all crossings", give, lying(0, 0, huge / 4), "longer than the memory"},
      {"promises much", give, lying(1000, 1000, 1000), "an answer that ends early"},
      {"an index beyond", give, changed([](Reply& r) { r.tets[4][2] = 8; }), "vertex 8 in tet 4 of 8 vertices"},
      {"an index far beyond", give, changed([](Reply& r) { r.tets[0][0] = ~0u; }), "vertex 4294967295 in tet 0"},
      {"a tet turned", give, changed([](Reply& r) { std::swap(r.tets[3][0], r.tets[3][1]); }),
       "found tet 3 of volume -"},
      {"all tets turned", give, changed([](Reply& r) {
         for (Tet& t : r.tets) std::swap(t[0], t[1]);
       }),
       "found tet 0 of volume -"},
      {"a tet of one vertex", give, changed([](Reply& r) {
         r.tets[1] = {3, 3, 3, 3};
       }),
       "found tet 1 of volume 0"},
      {"a tet left out", give, changed([](Reply& r) {
         r.tets.pop_back();
         r.regions.pop_back();
       }),
       "found tets of volume 0.833333 where the faces enclose 1"},
      {"a tet twice", give, changed([](Reply& r) {
         r.tets.push_back(r.tets[2]);
         r.regions.push_back(1);
       }),
       "found tets of volume 1.33333 where the faces enclose 1"},
      {"a region of its own number", give, changed([](Reply& r) { r.regions[2] = ~0u; }),
       "found a region numbered 4294967295"},
      {"a vertex that is no number", give,
       changed([](Reply& r) { r.added.emplace_back(0, std::numeric_limits<double>::quiet_NaN(), 0); }),
       "a vertex that is not finite"},
      {"no tets", give, changed([](Reply& r) {
         r.tets.clear();
         r.regions.clear();
       }),
       "found none; no faces cross"},
      {"crossings where there is no triangle", "cat > /dev/null; cat reply", changed([](Reply& r) {
         r.tets.clear();
         r.regions.clear();
         r.crossing = {12};
       }),
       "triangle 12 that it was not given"},
  };
}

}  // namespace

TEST(TetProcess, PlantedOnesAreCaught) {
  const std::size_t files = open_files();
  for (const Row& row : planted()) {
    const Planted script(row.commands, row.reply);
    const std::string said = outcome();
    EXPECT_NE(said.find(row.sentence), std::string::npos) << row.name << ": " << said;
    EXPECT_EQ(open_files(), files) << row.name;
    for (const std::string& process : processes_left()) ADD_FAILURE() << row.name << " left " << process;
  }
}

TEST(TetProcess, AGoodAnswerPasses) {
  const Planted script("cat > /dev/null; exec cat reply", Reply().text());
  EXPECT_EQ(outcome(), "5 tets") << "or the rows above would be caught for something else";
}

TEST(TetProcess, ChangedAnswersAreCaughtOrHarmless) {
  const std::string good = Reply().text();
  std::size_t caught = 0;
  for (std::uint64_t i = 0; i < 200; ++i) {
    std::string text = good;
    for (std::uint64_t k = 0; k < 1 + i % 3; ++k) {
      const auto at = static_cast<std::size_t>(random_unit(3 * i + k, 1) * static_cast<double>(text.size()));
      text[at] = static_cast<char>(256 * random_unit(3 * i + k, 2));
    }
    const Planted script("cat > /dev/null; exec cat reply", text);
    const std::string said = outcome();
    EXPECT_TRUE(said == "5 tets" || said.find("expected ") != std::string::npos) << said;
    caught += said != "5 tets";
  }
  EXPECT_GT(caught, 100u);
}

TEST(TetProcess, OnesThatHangAreEnded) {
  const std::string sleep = sleep_command();
  for (const std::string& commands :
       {"exec " + sleep, "cat > /dev/null; " + sleep, "exec 1>&-; " + sleep, "exec 0<&- 1>&-; " + sleep,
        "trap '' TERM INT HUP; " + sleep + " & wait; " + sleep}) {
    const Planted script(commands);
    const auto begin = std::chrono::steady_clock::now();
    EXPECT_NE(outcome(1).find("within 1 seconds, found none"), std::string::npos) << commands;
    EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5)) << commands;
    for (const std::string& process : processes_left()) ADD_FAILURE() << commands << " left " << process;
  }
}

TEST(TetProcess, OnesThatAreLeftWouldBeSeen) {
  ASSERT_EQ(std::system((sleep_command() + " &").c_str()), 0);
  const std::vector<std::string> left = processes_left();
  ASSERT_EQ(left.size(), 1u);
  kill(std::stoi(left[0]), SIGKILL);
  EXPECT_TRUE(processes_left().empty());
}

TEST(TetProcess, OnesThatAreNotThereAreNamed) {
  setenv("SINEW_TETS", "/nowhere/sinew-tets", 1);
  EXPECT_NE(outcome().find("/nowhere/sinew-tets: expected a program that starts"), std::string::npos) << outcome();
  unsetenv("SINEW_TETS");
}

TEST(TetProcess, ProgressEndsIt) {
  const std::size_t files = open_files();
  const Planted script("exec " + sleep_command());
  std::vector<std::string> notes;
  std::vector<double> seen;
  const auto mesh = tetrahedralized(box(), {}, notes, [&](double done) {
    seen.push_back(done);
    return seen.size() < 5;
  });
  EXPECT_FALSE(mesh.has_value());
  EXPECT_EQ(seen.size(), 5u);
  EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()) && seen.front() >= 0 && seen.back() <= 1);
  EXPECT_EQ(open_files(), files);
  EXPECT_TRUE(processes_left().empty());
}

TEST(TetProcess, TwoThreadsAtOnceDoNotMeet) {
  std::vector<std::size_t> counts(8);
  std::vector<std::thread> threads;
  for (std::size_t i = 0; i < counts.size(); ++i)
    threads.emplace_back([i, &counts] {
      std::vector<std::string> notes;
      const Shape shape =
          moved(sphere(), [i](const Vec3& p) { return Vec3(p * std::ldexp(1.0, static_cast<int>(i) - 4)); });
      counts[i] = tetrahedralized(shape, {}, notes)->tets.size();
    });
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(counts, std::vector<std::size_t>(counts.size(), counts[0]));
}

TEST(TetProcess, SigpipeIsNotRaised) {
  // A large request to one that ends without reading it: by default the signal would end this program.
  struct sigaction before {};
  struct sigaction standard {};
  standard.sa_handler = SIG_DFL;
  sigaction(SIGPIPE, &standard, &before);
  const Planted script("exec 0<&-; exit 12");
  std::vector<std::string> notes;
  EXPECT_THROW(tetrahedralized(torus(600, 200), {.vertices = 1000000}, notes), InputError);
  sigaction(SIGPIPE, &before, nullptr);
}

}  // namespace sinew
