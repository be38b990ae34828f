// sinew-bench [--only graph|solids|shells|poses] [--json FILE]: times the graph, with Google Benchmark, the tetrahedral
// editor and the shells on the cases of the papers' tables and prints the papers' figures beside today's. Absolute
// times are of this machine and this hour; ratios to REF carry over.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <numeric>

#include "deformers/graph.h"
#include "engine/geometry/parallel.h"
#include "engine/geometry/skin.h"
#include "engine/geometry/topology.h"
#include "tests/benchmarks/cases.h"
#include "tests/benchmarks/frames.h"
#include "tests/benchmarks/shells.h"
#include "tests/benchmarks/solid_times.h"

namespace sinew::benchmarks {

namespace {

/// A row of Table 1 of Sumner, Schmid and Pauly 2007: its size, and milliseconds of an iteration ("Solve") and of
/// moving all points ("Def") on a 2.4 GHz Core 2 Duo, one core.
struct Row {
  const char* name;
  std::size_t points;
  int nodes;
  std::size_t handles;
  double paper_solve, paper_def;
};
constexpr Row table1[] = {
    {"Raptor", 85792, 226, 27, 20, 22},    {"Giraffe", 79226, 221, 13, 17, 20},   {"Giraffe", 79226, 221, 670, 20, 20},
    {"Giraffe", 79226, 221, 1900, 25, 20}, {"Giraffe", 79226, 221, 5000, 38, 20}, {"Dino", 10002, 222, 540, 19, 3},
    {"Dino", 10002, 425, 540, 41, 3},      {"Dino", 10002, 1048, 540, 148, 3},
};

constexpr double drag_share = 0.01;  ///< of the diagonal, one mouse move

std::string key(const Row& row, const char* what) {
  return fmt::format("{}/{}/{}/{}/{}", row.name, row.points, row.nodes, row.handles, what);
}

GraphOptions options_of(int nodes, bool plain = false) {
  GraphOptions options;
  options.nodes = nodes;
  options.plain = plain;
  return options;
}

/// One mouse move: all iterations from the last solution, and all points moved.
void drag_step(benchmark::State& state, const Row& row) {
  const Case c = animal_case(row.points, row.handles);
  const auto deformer = make_graph_deformer(c.shape, options_of(row.nodes));
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  std::vector<Vec3> bent(c.shape->size());
  deformer->solve(dragged(c, 0, drag_share), quick);
  int step = 0, iterations = 0;
  for (auto _ : state) {
    const SolveReport report = deformer->solve(dragged(c, ++step, drag_share), quick);
    CHECK(report.status == Status::Converged, name_of(report.status), report.message);
    iterations += report.iterations;
    skin_points(deformer->weights(), deformer->pose(), c.shape->positions, bent);
    benchmark::DoNotOptimize(bent.data());
  }
  state.counters["iterations"] = iterations / static_cast<double>(std::max(1, step));
}

/// A mouse move of a fine layer [section 5, Figure 6]: 840 nodes of which all are free, or only about 138 around the
/// head, the rest of the shape fixed.
void fine_layer(benchmark::State& state, bool restricted) {
  const Case c = animal_case(85792, 27);
  const auto deformer = make_graph_deformer(c.shape, options_of(840));
  std::vector<Vec3> head;
  for (std::size_t i = c.held; i < c.constraints.handles[0].points.size(); ++i)
    head.push_back(c.constraints.handles[0].targets[i]);
  const Vec3 centre = std::accumulate(head.begin(), head.end(), Vec3(0, 0, 0)) / static_cast<double>(head.size());
  const auto at = [&](int step, double radius) {
    Constraints out = dragged(c, step, 0.2 * drag_share);
    Handle& handle = out.handles[0];
    if (!restricted) return out;
    handle.points.erase(handle.points.begin(), handle.points.begin() + static_cast<std::ptrdiff_t>(c.held));
    handle.targets.erase(handle.targets.begin(), handle.targets.begin() + static_cast<std::ptrdiff_t>(c.held));
    for (Index i = 0; i < c.shape->size(); ++i)
      if ((c.shape->positions[i] - centre).norm() > radius) out.fixed.push_back(i);
    return out;
  };
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  double radius = 0.1 * c.diagonal, free = 0;
  for (; radius < c.diagonal; radius *= 1.02) {
    SolveReport report = deformer->solve(at(0, radius), quick);
    free = report.counts.front().second / 12;
    if (!restricted || free >= 138) break;
  }
  int step = 0;
  Constraints now = at(0, radius);
  for (auto _ : state) {
    state.PauseTiming();
    now.handles = at(++step, radius).handles;
    state.ResumeTiming();
    deformer->solve(now, quick);
  }
  state.counters["free"] = free;
}

/// The paper's iteration: 12 unknowns a node, a new factor each time.
void plain_iteration(benchmark::State& state, const Row& row) {
  const Case c = animal_case(row.points, row.handles);
  const auto deformer = make_graph_deformer(c.shape, options_of(row.nodes, true));
  double seconds = 0;
  int iterations = 0, step = 0;
  deformer->solve(dragged(c, 0, drag_share), {});
  for (auto _ : state) {
    const SolveReport report = deformer->solve(dragged(c, ++step, drag_share), {});
    state.SetIterationTime(report.solve_seconds / std::max(1, report.iterations));
    seconds += report.solve_seconds;
    iterations += report.iterations;
  }
}

/// The final answer after the mouse is let go: from the last dragged pose to the minimum of the paper's energy.
void release(benchmark::State& state, const Row& row) {
  const Case c = animal_case(row.points, row.handles);
  const auto deformer = make_graph_deformer(c.shape, options_of(row.nodes));
  SolveOptions quick;
  quick.quality = SolveOptions::Quality::Interactive;
  int step = 0;
  for (auto _ : state) {
    state.PauseTiming();
    const Constraints at = dragged(c, 3 * ++step, drag_share);
    deformer->solve(at, quick);
    state.ResumeTiming();
    deformer->solve(at, {});
  }
}

void skinning(benchmark::State& state, const Row& row, int threads) {
  const Case c = animal_case(row.points, row.handles);
  const auto deformer = make_graph_deformer(c.shape, options_of(row.nodes));
  deformer->solve(dragged(c, 5, drag_share), {});
  std::vector<Vec3> bent(c.shape->size());
  const int before = thread_count();
  set_thread_count(threads);
  for (auto _ : state) {
    skin_points(deformer->weights(), deformer->pose(), c.shape->positions, bent);
    benchmark::DoNotOptimize(bent.data());
  }
  set_thread_count(before);
  state.counters["influences"] = static_cast<double>(deformer->weights().influences());
}

/// A cold solve of a Botsch-Sorkine sample, from rest to the minimum.
void cold_solve(benchmark::State& state, const std::string& name, int nodes) {
  const BenchmarkEdit edit = benchmark_edit(name);
  const auto deformer = make_graph_deformer(edit.shape, options_of(nodes));
  deformer->solve(edit.constraints, {});
  SolveReport report;
  for (auto _ : state) {
    deformer->reset();
    report = deformer->solve(edit.constraints, {});
  }
  const Quality quality = quality_of(*edit.shape, skin(*edit.shape, deformer->weights(), deformer->pose()).positions);
  state.counters["iterations"] = report.iterations;
  state.counters["energy"] = report.energy.front().second;
  state.counters["edge_rms"] = quality.edge_rms;
  state.counters["edge_max"] = quality.edge_max;
  state.counters["volume"] = quality.volume_change;
  state.counters["handle_rms"] = report.handle_rms;
  state.counters["nodes"] = report.counts.at(1).second;
}

void make(benchmark::State& state, const Row& row) {
  const Case c = animal_case(row.points, row.handles);
  for (auto _ : state) benchmark::DoNotOptimize(make_graph_deformer(c.shape, options_of(row.nodes)));
}

/// Medians over repetitions, by the name of the benchmark.
class Medians : public benchmark::BenchmarkReporter {
 public:
  struct Figure {
    std::vector<double> milliseconds;
    benchmark::UserCounters counters;
    double median() const {
      std::vector<double> sorted = milliseconds;
      std::sort(sorted.begin(), sorted.end());
      return sorted.empty() ? 0 : sorted[sorted.size() / 2];
    }
  };
  std::map<std::string, Figure> figures;

  bool ReportContext(const Context&) override { return true; }
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration) continue;
      Figure& figure = figures[run.run_name.function_name];
      figure.milliseconds.push_back(run.GetAdjustedRealTime());
      figure.counters = run.counters;
    }
  }
};

template <class... Arguments>
void add(const std::string& name, void (*body)(benchmark::State&, Arguments...), std::decay_t<Arguments>... arguments) {
  auto* b = benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) { body(state, arguments...); });
  b->Unit(benchmark::kMillisecond)->Repetitions(5)->MinTime(0.1)->UseRealTime();
}

void register_all() {
  benchmark::RegisterBenchmark("REF",
                               [](benchmark::State& state) {
                                 for (auto _ : state) state.SetIterationTime(ref_seconds());
                               })
      ->Unit(benchmark::kMillisecond)
      ->Repetitions(5)
      ->Iterations(1)
      ->UseManualTime();
  for (const Row& row : table1) {
    add<const Row&>(key(row, "drag"), drag_step, row);
    add<const Row&>(key(row, "release"), release, row);
    add<const Row&, int>(key(row, "skin 1 thread"), skinning, row, 1);
    benchmark::RegisterBenchmark(key(row, "plain").c_str(),
                                 [&row](benchmark::State& state) { plain_iteration(state, row); })
        ->Unit(benchmark::kMillisecond)
        ->Repetitions(3)
        ->Iterations(3)
        ->UseManualTime();
  }
  add<const Row&>(key(table1[1], "make"), make, table1[1]);
  add<bool>("fine/all", fine_layer, false);
  add<bool>("fine/restricted", fine_layer, true);
  add<const std::string&, int>("plane/288", cold_solve, "plane", 288);
  for (const char* name : {"plane", "bar", "cactus", "cylinder"})
    add<const std::string&, int>(fmt::format("{}/300", name), cold_solve, name, 300);
}

/// A row of what moves: the paper's figures of an iteration and of moving all points, milliseconds.
struct MovingRow {
  const char *name, *sample;
  double paper_solve, paper_def;
};
constexpr MovingRow moving_rows[] = {{"Horse", "walk", 23, 2}, {"Fluid", "jet", 4, 0.5}};

/// Frames of the samples that move; each case is timed once over all of its frames.
void print_frames(double ref, std::map<std::string, Medians::Figure>& figures) {
  fmt::print(
      "\nBatch editing, Table 1 (paper: ms an iteration and ms for all points). Today in ms a frame, one core, medians "
      "over all frames:\nall iterations to the minimum from the key's solution; all points (of a stream with binding "
      "them); evaluate() whole, with attributes.\n");
  fmt::print("{:<8} {:>7} {:>6} | {:>6} {:>5} | {:>7} {:>6} {:>7} {:>13} {:>8} {:>9}\n", "model", "points", "nodes",
             "Solve", "Def", "solve", "iters", "points", "(s + p) / REF", "whole", "frames/s");
  for (const MovingRow& row : moving_rows) {
    const FrameSeconds s = time_frames(moving_case(row.sample));
    fmt::print("{:<8} {:>7.0f} {:>6.0f} | {:>6.0f} {:>5.1f} | {:>7.2f} {:>6.0f} {:>7.3f} {:>13.5f} {:>8.2f} {:>9.0f}\n",
               row.name, s.points, s.nodes, row.paper_solve, row.paper_def, 1e3 * s.solve, s.iterations, 1e3 * s.skin,
               1e3 * (s.solve + s.skin) / ref, 1e3 * s.whole, 1 / s.whole);
    Medians::Figure& figure = figures[fmt::format("{}/frame", row.name)];
    figure.milliseconds = {1e3 * s.whole};
    figure.counters["solve"] = 1e3 * s.solve;
    figure.counters["points"] = 1e3 * s.skin;
  }
}

void print_tables(std::map<std::string, Medians::Figure>& figures) {
  const double ref = figures["REF"].median();
  fmt::print("REF {:.0f} ms: Eigen SimplicialLDLT, analyse and factorize, 7-point Laplacian of 30^3\n\n", ref);
  fmt::print(
      "Embedded deformation, Table 1 (paper: 2.4 GHz Core 2 Duo, ms). Today in ms: the paper's iteration with a new "
      "factor;\n"
      "one mouse move of 1 % of the diagonal (all iterations and all points); the final answer on release; all points "
      "once, one thread.\n");
  fmt::print("{:<8} {:>7} {:>6} {:>6} | {:>6} {:>5} | {:>9} {:>9} {:>8} {:>6} {:>8} {:>7} {:>9}\n", "model", "points",
             "nodes", "csts", "Solve", "Def", "iteration", "mouse move", "/ REF", "iters", "release", "points",
             "M infl./s");
  for (const Row& row : table1) {
    auto& drag = figures[key(row, "drag")];
    auto& skin = figures[key(row, "skin 1 thread")];
    fmt::print(
        "{:<8} {:>7} {:>6} {:>6} | {:>6.0f} {:>5.0f} | {:>9.2f} {:>10.2f} {:>8.5f} {:>6.1f} {:>8.1f} {:>7.2f} "
        "{:>9.0f}\n",
        row.name, row.points, row.nodes, row.handles, row.paper_solve, row.paper_def,
        figures[key(row, "plain")].median(), drag.median(), drag.median() / ref, drag.counters["iterations"].value,
        figures[key(row, "release")].median(), skin.median(), skin.counters["influences"].value / skin.median() / 1e3);
  }
  fmt::print("\nMaking a deformer (221 nodes, 79,226 points: sampling, binding, edges): {:.0f} ms\n\n",
             figures[key(table1[1], "make")].median());
  fmt::print(
      "A fine layer of 840 nodes, one mouse move of 0.2 % of the diagonal (paper, Figure 6: interactive with 138 "
      "free)\n");
  for (const char* name : {"fine/all", "fine/restricted"})
    fmt::print("  {:>4.0f} nodes free: {:.2f} ms, {:.5f} REF\n", figures[name].counters["free"].value,
               figures[name].median(), figures[name].median() / ref);
  fmt::print("\nBotsch-Sorkine samples, cold from rest to the minimum\n");
  fmt::print("{:<10} {:>6} {:>6} {:>8} {:>8} {:>10} {:>9} {:>9} {:>9} {:>11}\n", "shape", "nodes", "iters", "ms",
             "/ REF", "energy", "edge rms", "edge max", "volume", "handle rms");
  for (const char* name : {"plane/288", "plane/300", "bar/300", "cactus/300", "cylinder/300"}) {
    auto& f = figures[name];
    fmt::print("{:<10} {:>6.0f} {:>6.0f} {:>8.1f} {:>8.4f} {:>10.6f} {:>9.4f} {:>9.3f} {:>8.1f}% {:>11.2g}\n",
               std::string(name).substr(0, std::string(name).find('/')), f.counters["nodes"].value,
               f.counters["iterations"].value, f.median(), f.median() / ref, f.counters["energy"].value,
               f.counters["edge_rms"].value, f.counters["edge_max"].value, 100 * f.counters["volume"].value,
               f.counters["handle_rms"].value);
  }
}

/// The figures of tables printed elsewhere: by row and name, times in milliseconds.
void add_tables(std::map<std::string, Medians::Figure>& figures,
                const std::map<std::string, std::map<std::string, double>>& tables) {
  for (const auto& [name, values] : tables)
    for (const auto& [what, value] : values) {
      Medians::Figure& figure = figures[name];
      if (what == (values.contains("solve") ? "solve" : "plain_frame"))
        figure.milliseconds = {value};
      else
        figure.counters[what] = value;
    }
}

void write_json(const std::string& path, const std::map<std::string, Medians::Figure>& figures) {
  nlohmann::ordered_json out;
  for (const auto& [name, figure] : figures) {
    out[name]["milliseconds"] = figure.median();
    for (const auto& [counter, value] : figure.counters) out[name][counter] = value.value;
  }
  std::ofstream file(path);
  file << out.dump(2) << '\n';
  if (!file.flush()) fmt::print(stderr, "sinew-bench: {}: expected a file that can be written, found an error\n", path);
}

}  // namespace

}  // namespace sinew::benchmarks

int main(int argc, char** argv) {
  using namespace sinew::benchmarks;
  std::string json, only;
  for (int i = 1; i < argc; i += 2) {
    std::string* const value = std::strcmp(argv[i], "--json") == 0   ? &json
                               : std::strcmp(argv[i], "--only") == 0 ? &only
                                                                     : nullptr;
    if (value == nullptr || i + 1 == argc) {
      fmt::print(stderr, "usage: sinew-bench [--only graph|solids|shells|poses] [--json FILE]\n");
      return 2;
    }
    *value = argv[i + 1];
  }
  Medians medians;
  if (only.empty() || only == "graph") {
    register_all();
    benchmark::RunSpecifiedBenchmarks(&medians);
    print_tables(medians.figures);
    print_frames(medians.figures["REF"].median(), medians.figures);
  }
  if (only.empty() || only == "solids") add_tables(medians.figures, print_solids());
  if (only.empty() || only == "shells") add_tables(medians.figures, print_shells());
  if (only.empty() || only == "poses") add_tables(medians.figures, print_poses());
  if (!json.empty()) write_json(json, medians.figures);
  return 0;
}
