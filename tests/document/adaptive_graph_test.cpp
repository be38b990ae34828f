/// A layer whose graph grows where the edit bends, through evaluate.

#include <gtest/gtest.h>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "tests/document/moving.h"

namespace sinew::document {

TEST(AdaptiveGraph, ASecondEvaluationGivesTheSame) {
  const auto input = std::make_shared<const Sequence>(waving_tube(3));
  std::vector<Layer> layers{tube_layer()};
  std::erase_if(layers[0].settings, [](const SettingEdit& s) { return s.name == "nodes"; });
  layers[0].settings.push_back({"nodes", 20.0, {}});
  layers[0].settings.push_back({"adapt", 60.0, {}});
  Key key;
  key.frame = 2;
  key.handles.emplace_back().move = Vec3(0, 0.4, 0);
  layers[0].keys = {key};
  Workspace workspace(input, methods()), other(input, methods());
  const Evaluation once = evaluate(workspace, layers, 2);
  EXPECT_GT(once.map_energies.at(0).size(), 20u);
  EXPECT_LE(once.map_energies.at(0).size(), 60u);
  EXPECT_TRUE(once.shape->positions == evaluate(workspace, layers, 2).shape->positions);
  EXPECT_TRUE(evaluate(other, layers, 3).shape->positions == evaluate(workspace, layers, 3).shape->positions);
  EXPECT_TRUE(once.shape->positions == evaluate(other, layers, 2).shape->positions);
}

}  // namespace sinew::document
