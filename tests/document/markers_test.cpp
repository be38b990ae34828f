#include "engine/document/markers.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>

#include "deformers/methods.h"
#include "engine/document/edit.h"
#include "engine/document/evaluate.h"
#include "engine/geometry/error.h"
#include "engine/io/io.h"
#include "tests/deformers/solids.h"
#include "tests/geometry/lobed_body.h"

namespace sinew::document {
namespace {

/// A box of 4 x 4 x 8 cells, 0.5 high, and a motion of five markers in another unit and other axes: three at its foot,
/// two above, of which one is inside; they lean over to the side from frame to frame. Marker E is lost in frames 4
/// to 6.
class MarkersTest : public testing::Test {
 protected:
  MarkersTest() : folder_(std::filesystem::temp_directory_path() / ("sinew-markers-" + std::to_string(getpid()))) {
    std::filesystem::create_directories(folder_);
    const test::Solid solid = test::box(4, 4, 8, 1.0 / 16);
    shape_ = std::make_shared<Shape>(test::shape_of(solid));
    std::ofstream file(folder_ / "m.csv");
    file << "frame,A.x,A.y,A.z,B.x,B.y,B.z,C.x,C.y,C.z,D.x,D.y,D.z,E.x,E.y,E.z\n";
    for (int f = 1; f <= 8; ++f) {
      file << f;
      for (int m = 0; m < 5; ++m) {
        const Vec3 p = captured(place(m) + (m >= 3 ? 0.02 * (f - 1) : 0.0) * Vec3(1, 0, 0));
        if (m == 4 && f >= 4 && f <= 6)
          file << ",,,";
        else
          file << ',' << p.x() << ',' << p.y() << ',' << p.z();
      }
      file << '\n';
    }
  }
  ~MarkersTest() override { std::filesystem::remove_all(folder_); }

  static Vec3 place(int m) {
    const Vec3 places[] = {{0, 0, 0}, {0.25, 0, 0}, {0, 0.25, 0}, {0.13, 0.12, 0.45}, {0.12, 0.12, 0.56}};
    return places[m];
  }
  /// In millimetres, z up made x up, somewhere else.
  static Vec3 captured(const Vec3& p) { return 1000 * Vec3(p.z(), p.x(), p.y()) + Vec3(30, -20, 100); }

  MarkersEdit edit() const {
    MarkersEdit out;
    out.path = (folder_ / "m.csv").string();
    for (int m = 0; m < 3; ++m) out.matches.push_back({std::string(1, static_cast<char>('A' + m)), place(m), {}});
    return out;
  }
  static void save(const std::string& path, const io::Trajectories& motion) {
    io::WriteReport report;
    io::save_bytes(path, io::motion_format_of(path)->write(motion, report), true);
  }
  std::string mistake(const MarkersEdit& edit) const { return mistake(edit, *shape_); }
  static std::string mistake(const MarkersEdit& edit, const Shape& body) {
    try {
      const Markers markers(edit, body);
    } catch (const InputError& error) {
      return error.what();
    }
    return "none";
  }

  std::filesystem::path folder_;
  std::shared_ptr<const Shape> shape_;
};

TEST_F(MarkersTest, AreAlignedByThreeMatches) {
  const Markers markers(edit(), *shape_);
  EXPECT_NEAR(markers.scale(), 1e-3, 1e-12);
  EXPECT_LT(markers.fit_rms(), 1e-9);
  const Handle handle = markers.handle(3, Vec3(1, 2, 3));
  ASSERT_EQ(handle.places.size(), 5u);
  for (int m = 0; m < 5; ++m) {
    EXPECT_LT((handle.places[static_cast<std::size_t>(m)] + Vec3(1, 2, 3) - place(m)).norm(), 1e-6);
    const Vec3 to = place(m) + (m >= 3 ? 0.04 : 0.0) * Vec3(1, 0, 0);
    EXPECT_LT((handle.targets[static_cast<std::size_t>(m)] + Vec3(1, 2, 3) - to).norm(), 1e-6);
  }
}

TEST_F(MarkersTest, GapsAreBridgedOrTheMarkerIsReleasedAndBothAreTold) {
  EXPECT_EQ(Markers(edit(), *shape_).handle(5, Vec3::Zero()).places.size(), 5u);
  MarkersEdit strict = edit();
  strict.bridge = 2;
  const Markers markers(strict, *shape_);
  EXPECT_EQ(markers.handle(5, Vec3::Zero()).places.size(), 4u);
  EXPECT_EQ(markers.handle(7, Vec3::Zero()).places.size(), 5u);
  ASSERT_EQ(markers.notes().size(), 1u);
  EXPECT_NE(markers.notes()[0].find("released (4-6)"), std::string::npos) << markers.notes()[0];
}

TEST_F(MarkersTest, APictureTellsApartWhatWasNotSeen) {
  const Vec3 origin(1, 2, 3);
  EXPECT_EQ(Markers(edit(), *shape_).picture(3, origin).seen.size(), 5u);
  const Markers::Picture bridged = Markers(edit(), *shape_).picture(5, origin);
  ASSERT_EQ(bridged.unseen.size(), 1u);
  EXPECT_LT((bridged.unseen[0] + origin - place(4) - Vec3(0.08, 0, 0)).norm(), 1e-6);
  MarkersEdit strict = edit();
  strict.bridge = 2;
  const Markers::Picture released = Markers(strict, *shape_).picture(6, origin);
  ASSERT_EQ(released.unseen.size(), 1u);
  EXPECT_LT((released.unseen[0] + origin - place(4) - Vec3(0.04, 0, 0)).norm(), 1e-6) << "not where it was in frame 3";
  EXPECT_TRUE(Markers(edit(), *shape_).picture(9, origin).seen.empty());
}

TEST_F(MarkersTest, WithoutMatchesTheyAreLaidOverTheShape) {
  const Bounds shape{Vec3(1, 1, 1), Vec3(1.2, 2, 1.2)};
  const MarkersEdit over = markers_over((folder_ / "m.csv").string(), shape);
  EXPECT_TRUE(over.matches.empty());
  Bounds bounds;
  Markers(over, *shape_).picture(1, Vec3::Zero()).add_to(bounds);
  EXPECT_NEAR(bounds.diagonal(), shape.diagonal(), 1e-9);
  EXPECT_LT((bounds.centre() - shape.centre()).norm(), 1e-9);
  Eigen::Index longest = 0;
  (bounds.max - bounds.min).maxCoeff(&longest);
  EXPECT_EQ(longest, 1) << "the motion's is x, the shape's y";
}

TEST_F(MarkersTest, CorrespondingOnesPullTheirMatches) {
  MarkersEdit pulls = edit();
  pulls.corresponding = true;
  pulls.matches.push_back({"E", Vec3(0.2, 0.2, 0.5), {}});
  const Handle handle = Markers(pulls, *shape_).handle(1, Vec3::Zero());
  ASSERT_EQ(handle.places.size(), 4u);
  EXPECT_EQ(handle.places[3], Vec3(0.2, 0.2, 0.5));
  EXPECT_GT((handle.targets[3] - handle.places[3]).norm(), 0.005);
}

TEST_F(MarkersTest, MistakesHaveTheirSentences) {
  MarkersEdit other = edit();
  other.first = 9;
  EXPECT_NE(mistake(other).find("a first frame from 1 to 8, found 9"), std::string::npos) << mistake(other);
  other = edit();
  other.only = {"A", "Z"};
  EXPECT_NE(mistake(other).find("found \"Z\""), std::string::npos) << mistake(other);
  other = edit();
  other.matches[1].name = "Q";
  EXPECT_NE(mistake(other).find("found \"Q\""), std::string::npos) << mistake(other);
  other = edit();
  other.matches[2].place = Vec3(0.5, 0, 0);
  EXPECT_NE(mistake(other).find("found a line"), std::string::npos) << mistake(other);
  EXPECT_EQ(mistake(edit()), "none");
}

/// Markers anywhere on a body, told of by nothing but where they are in the first frame.
TEST_F(MarkersTest, WithoutMatchesTheyAreLaidOnTheBody) {
  auto body = std::make_shared<Shape>(test::lobed_body());
  body->origin = Vec3(1000, -2000, 500);
  const std::vector<Vec3> places = test::places_on(*body, 40, 7);
  io::Trajectories motion;
  motion.frames.resize(2);
  for (std::size_t m = 0; m < places.size(); ++m) {
    motion.names.push_back("M" + std::to_string(m));
    for (int f = 0; f < 2; ++f)
      motion.frames[static_cast<std::size_t>(f)].push_back(captured(places[m] + 0.1 * f * Vec3(0, 0, 1)));
  }
  MarkersEdit laid;
  laid.path = (folder_ / "laid.csv").string();
  save(laid.path, motion);
  const Markers markers(laid, *body);
  EXPECT_NEAR(markers.scale(), 1e-3, 1e-8);
  EXPECT_LT(markers.fit_rms(), 1e-5);
  ASSERT_EQ(markers.notes().size(), 1u);
  EXPECT_EQ(markers.notes()[0].rfind("40 markers were laid on the shape, scaled by 0.001; 100 %", 0), 0u)
      << markers.notes()[0];
  const Handle handle = markers.handle(2, body->origin);
  ASSERT_EQ(handle.places.size(), places.size());
  for (std::size_t m = 0; m < places.size(); ++m) {
    EXPECT_LT((handle.places[m] - places[m]).norm(), 1e-4);
    EXPECT_LT((handle.targets[m] - places[m] - Vec3(0, 0, 0.1)).norm(), 1e-4);
  }

  // Where something is said it holds.
  MarkersEdit said = laid;
  said.move = Vec3(0, 0, 0);
  EXPECT_EQ(Markers(said, *body).handle(1, Vec3::Zero()).places[3], motion.frames[0][3]);

  // A few tell nothing, and a cloud lies nowhere.
  MarkersEdit few = laid;
  few.only.assign(motion.names.begin(), motion.names.begin() + 20);
  EXPECT_NE(mistake(few, *body).find("at least 24 markers to lay on the shape, found 20"), std::string::npos)
      << mistake(few, *body);
  for (std::size_t m = 0; m < places.size(); ++m) motion.frames[0][m] *= 0.05 + 0.9 * random_unit(1, m);
  save(laid.path, motion);
  EXPECT_NE(mistake(laid, *body).find("or \"matches\", found "), std::string::npos) << mistake(laid, *body);
}

TEST_F(MarkersTest, DriveASolidFrameByFrame) {
  Layer layer;
  layer.method = "tet";
  layer.markers = edit();
  const auto still = std::make_shared<const Sequence>(sinew::still(shape_));
  const auto frames = std::make_shared<const Sequence>(with_frames_of_markers(*still, std::span(&layer, 1)));
  EXPECT_EQ(frames->frames.size(), 8u);
  const std::vector<Layer> layers{layer};
  Workspace all(frames, methods());
  for (const int frame : {1, 8, 5}) {
    const Evaluation bent = evaluate(all, layers, frame, {});
    // Any order of frames gives the same bits.
    Workspace alone(frames, methods());
    EXPECT_TRUE(evaluate(alone, layers, frame, {}).shape->positions == bent.shape->positions) << frame;
    const double top = (bent.shape->positions.back() - shape_->positions.back()).x();
    EXPECT_NEAR(top, 0.02 * (frame - 1), 0.3 * 0.02 * (frame - 1) + 1e-6) << frame;
    EXPECT_LT(bent.reports[0].solve.handle_rms, 2e-3);
  }
}

TEST_F(MarkersTest, AGraphRefusesThem) {
  Layer layer;
  layer.markers = edit();
  EXPECT_THROW(Workspace(shape_, methods()).update(std::span(&layer, 1), {}), InputError);
}

}  // namespace
}  // namespace sinew::document
