/// Attributes that bend by the derivative of the map, through a whole edit: solving it and applying its pose file must
/// agree, and both must bind with gradients.

#include <gtest/gtest.h>

#include "deformers/methods.h"
#include "engine/document/evaluate.h"
#include "engine/document/pose_file.h"
#include "engine/geometry/skin.h"
#include "tests/splats.h"

namespace sinew::document {

namespace {

Selection box(const Vec3& low, const Vec3& high) {
  Selection out;
  out.what = SelectBox{low, high};
  return out;
}

/// A bar of splats along x; two layers turn one end about different axes.
struct Bar {
  std::shared_ptr<Shape> rest = std::make_shared<Shape>();
  std::vector<Layer> layers;

  Bar() {
    RandomSplats random(6);
    rest->origin = Vec3(100, 0, 0);
    for (int i = 0; i < 1500; ++i)
      rest->positions.push_back(random.vector().cwiseProduct(Vec3(1.5, 0.2, 0.2)) + Vec3(1.5, 0, 0));
    add_splats(*rest, 0.02, 3);
    for (const Vec3& axis : {Vec3(0, 1, 0), Vec3(1, 0, 1)}) {
      Layer layer;
      layer.settings = {{"nodes", 40.0, {}}};
      layer.fixed = {box(Vec3(99, -1, -1), Vec3(100.3, 1, 1))};
      HandleEdit handle;
      handle.points = box(Vec3(102.7, -1, -1), Vec3(104, 1, 1));
      handle.motion.rotate = Rotation{axis.normalized(), 50, Vec3(101.5, 0, 0)};
      layer.handles = {handle};
      layers.push_back(layer);
    }
  }
};

}  // namespace

TEST(SplatEdit, SolvingAndApplyingGiveTheSameSplats) {
  const Bar bar;
  const Evaluation evaluation = evaluate(bar.rest, bar.layers, methods());
  const Shape& solved = *evaluation.shape;
  for (const char* name : {"rot", "scale", "f_rest"}) EXPECT_FALSE(*solved.find(name) == *bar.rest->find(name)) << name;
  const SolvedEdit edit = parse_solved_edit("p.json", solved_edit_text(solved_edit(evaluation, bar.layers)));
  const Shape applied = PoseApplier(edit, methods(), bar.rest->origin).apply(*bar.rest);
  EXPECT_TRUE(applied.positions == solved.positions);
  for (const Attribute& attribute : solved.attributes)
    EXPECT_TRUE(*applied.find(attribute.name) == attribute) << attribute.name;

  // With weights that have no gradients the same maps give other splats.
  Shape blended = *bar.rest;
  for (const LayerResult& layer : evaluation.layers) blended = skin(blended, *layer.weights, *layer.pose);
  EXPECT_TRUE(blended.positions == solved.positions);
  EXPECT_FALSE(*blended.find("rot") == *solved.find("rot"));
}

TEST(SplatEdit, SaysWhatItDoesNotBend) {
  Bar bar;
  bar.rest->attributes.erase(bar.rest->attributes.begin() + 3);
  ASSERT_EQ(bar.rest->find("scale"), nullptr);
  const Evaluation evaluation = evaluate(bar.rest, bar.layers, methods());
  EXPECT_TRUE(*evaluation.shape->find("rot") == *bar.rest->find("rot"));
  ASSERT_EQ(evaluation.reports.size(), 2u);
  ASSERT_EQ(evaluation.reports[0].notes.size(), 1u) << "once, not once a layer";
  EXPECT_EQ(evaluation.reports[0].notes[0].substr(0, 21), "\"rot\" stays as it is:");
  EXPECT_TRUE(evaluation.reports[1].notes.empty());
}

}  // namespace sinew::document
