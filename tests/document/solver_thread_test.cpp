#include "engine/document/solver_thread.h"

#include <gtest/gtest.h>

#include <chrono>

#include "engine/document/evaluate.h"
#include "tests/document/toy_method.h"

namespace sinew::document {

namespace {

Layer mover(const Vec3& move, double pause = 0) {
  Layer layer;
  layer.method = "toy";
  layer.settings = {{"pause", pause, {}}};
  HandleEdit handle;
  handle.points.what = SelectNearest{Vec3(0, 0, 0)};
  handle.motion.move = move;
  layer.handles = {handle};
  return layer;
}

/// The first answer that `such` holds for; fails the test after 20 seconds.
SolveAnswer wait_for(SolverThread& solver, const std::function<bool(const SolveAnswer&)>& such) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (std::chrono::steady_clock::now() < end) {
    const std::optional<SolveAnswer> answer = solver.answer();
    if (answer && such(*answer)) return *answer;
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
  ADD_FAILURE() << "no such answer";
  return {};
}

double moved(const SolveAnswer& answer) {
  return answer.layers.empty() ? -1 : (*answer.layers.back().pose)[0](0, 3);
}

constexpr auto final_quality = SolveOptions::Quality::Final;
constexpr auto interactive = SolveOptions::Quality::Interactive;

}  // namespace

TEST(SolverThread, AnswersWithThePosesOfEvaluate) {
  const Method methods[] = {toy_method()};
  const auto input = std::make_shared<const Sequence>(still(line_of_points(100)));
  const std::vector<Layer> layers{mover(Vec3(1, 0, 0)), mover(Vec3(0, 1, 0))};
  SolverThread solver(methods);
  solver.ask({7, input, 1, layers, final_quality});
  const SolveAnswer answer = wait_for(solver, [](const SolveAnswer& a) { return a.finished; });
  EXPECT_EQ(answer.ticket, 7u);
  EXPECT_TRUE(answer.final_quality);
  const Evaluation same = evaluate(input->load(1), layers, methods);
  ASSERT_EQ(answer.layers.size(), 2u);
  EXPECT_EQ(*answer.layers[1].pose, *same.layers[1].pose);
}

TEST(SolverThread, PublishesWhileItSolvesAndANewerRequestStopsIt) {
  const Method methods[] = {toy_method()};
  const auto input = std::make_shared<const Sequence>(still(line_of_points(10)));
  SolverThread solver(methods);
  solver.ask({1, input, 1, {mover(Vec3(1, 0, 0), 0.02)}, interactive});
  const SolveAnswer first = wait_for(solver, [](const SolveAnswer& a) { return !a.finished; });
  EXPECT_EQ(first.ticket, 1u);
  EXPECT_GT(moved(first), 0);
  solver.ask({2, input, 1, {mover(Vec3(-1, 0, 0), 0.02)}, interactive});
  const auto asked = std::chrono::steady_clock::now();
  const SolveAnswer second = wait_for(solver, [](const SolveAnswer& a) { return a.ticket == 2; });
  EXPECT_LT(std::chrono::steady_clock::now() - asked, std::chrono::milliseconds(700));  // alone, the first takes 0.8 s
  EXPECT_LT(moved(second), 1);
}

TEST(SolverThread, AStormOfRequestsEndsAtTheNewest) {
  const Method methods[] = {toy_method()};
  const auto input = std::make_shared<const Sequence>(still(line_of_points(1000)));
  std::atomic<int> woken = 0;
  SolverThread solver(methods, [&] { ++woken; });
  for (std::uint64_t i = 1; i <= 2000; ++i)
    solver.ask({i, input, 1, {mover(Vec3(static_cast<double>(i), 0, 0))}, i == 2000 ? final_quality : interactive});
  const SolveAnswer last = wait_for(solver, [](const SolveAnswer& a) { return a.final_quality; });
  EXPECT_EQ(last.ticket, 2000u);
  EXPECT_NEAR(moved(last), 2000, 1e-9);
  EXPECT_GT(woken, 0);
  EXPECT_FALSE(solver.answer().has_value());
}

TEST(SolverThread, AnErrorIsASentenceAndTheNextRequestWorks) {
  const Method methods[] = {toy_method()};
  const auto input = std::make_shared<const Sequence>(still(line_of_points(10)));
  SolverThread solver(methods);
  Layer bad = mover(Vec3(1, 0, 0));
  bad.handles[0].points.what = SelectIndices{Shared<Index>({10})};
  solver.ask({1, input, 1, {bad}, final_quality});
  const SolveAnswer failed = wait_for(solver, [](const SolveAnswer& a) { return a.finished; });
  EXPECT_NE(failed.error.find("expected indices below 10"), std::string::npos);
  EXPECT_TRUE(failed.layers.empty());
  solver.ask({2, input, 1, {mover(Vec3(1, 0, 0))}, final_quality});
  const SolveAnswer good = wait_for(solver, [](const SolveAnswer& a) { return a.finished; });
  EXPECT_EQ(good.error, "");
  EXPECT_NEAR(moved(good), 1, 1e-9);
}

TEST(SolverThread, CancelLeadsToNoResultAndLeavingStopsASolve) {
  const Method methods[] = {toy_method()};
  const auto input = std::make_shared<const Sequence>(still(line_of_points(10)));
  const auto begin = std::chrono::steady_clock::now();
  {
    SolverThread solver(methods);
    solver.ask({1, input, 1, {mover(Vec3(1, 0, 0), 0.02)}, final_quality});
    wait_for(solver, [](const SolveAnswer& a) { return !a.finished; });
    solver.cancel();
    while (solver.busy()) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const std::optional<SolveAnswer> last = solver.answer();
    EXPECT_TRUE(!last || !last->finished);
    solver.ask({2, input, 1, {mover(Vec3(1, 0, 0), 1)}, final_quality});
    wait_for(solver, [](const SolveAnswer& a) { return a.ticket == 2; });
  }
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));  // 40 iterations of 1 s were asked for
}

}  // namespace sinew::document
