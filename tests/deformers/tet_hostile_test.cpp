/// Meshes that no tets can be made of: each ends in its sentence.

#include <gtest/gtest.h>

#include <limits>

#include "deformers/tet_mesh.h"
#include "engine/geometry/error.h"
#include "engine/geometry/random.h"
#include "tests/deformers/tet_shapes.h"

namespace sinew {

namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinite = std::numeric_limits<double>::infinity();

struct Row {
  std::string name;
  Shape shape;
  std::string sentence;  ///< a part of what is to be said
  TetMeshOptions options = {};
};

Shape with_point(Shape shape, Index i, const Vec3& position) {
  shape.positions[i] = position;
  return shape;
}

Shape with_face(Shape shape, std::vector<Index> corners) {
  shape.faces.add(corners);
  return shape;
}

Shape points(std::vector<Vec3> positions, const std::vector<std::vector<Index>>& faces) {
  Shape shape;
  shape.positions = std::move(positions);
  for (const auto& face : faces) shape.faces.add(face);
  return shape;
}

Shape without(const Shape& shape, const std::vector<std::size_t>& faces) {
  return with_faces(shape, [&](std::size_t f) { return std::find(faces.begin(), faces.end(), f) == faces.end(); });
}

Shape random_triangles(int count) {
  Shape shape;
  for (int k = 0; k < 3 * count; ++k) {
    const auto i = static_cast<std::uint64_t>(k);
    shape.positions.emplace_back(random_unit(1, i), random_unit(2, i), random_unit(3, i));
  }
  for (Index t = 0; t < static_cast<Index>(count); ++t) add_face(shape, {3 * t, 3 * t + 1, 3 * t + 2});
  return shape;
}

/// Closed, with one side: its v runs the other way after a turn of u.
Shape klein_bottle(Index columns, Index rows) {
  Shape shape = grid(columns, rows, false, true, [=](double u, double v) {
    const double a = 2 * M_PI * u * (columns - 1) / columns, b = 2 * M_PI * v;
    const double r = 2 + std::cos(a / 2) * std::sin(b) - std::sin(a / 2) * std::sin(2 * b);
    return Vec3(r * std::cos(a), r * std::sin(a), std::sin(a / 2) * std::sin(b) + std::cos(a / 2) * std::sin(2 * b));
  });
  for (Index v = 0; v < rows; ++v) {
    const Index up = (v + 1) % rows, last = columns - 1;
    add_face(shape, {v * columns + last, (rows - v) % rows * columns, (rows - up) % rows * columns});
    add_face(shape, {v * columns + last, (rows - up) % rows * columns, up * columns + last});
  }
  return shape;
}

Shape moebius_strip() {
  Shape shape = grid(40, 5, false, false, [](double u, double v) {
    const double a = 2 * M_PI * u * 39 / 40, w = v - 0.5;
    return Vec3((1 + w * std::cos(a / 2)) * std::cos(a), (1 + w * std::cos(a / 2)) * std::sin(a), w * std::sin(a / 2));
  });
  for (Index v = 0; v < 4; ++v) add_face(shape, {v * 40 + 39, (4 - v) * 40, (3 - v) * 40, (v + 1) * 40 + 39});
  return shape;
}

/// A tube along a curve that runs through itself.
Shape crossing_tube() {
  return grid(80, 8, true, true, [](double u, double v) {
    const double a = 2 * M_PI * u, b = 2 * M_PI * v;
    const Vec3 centre(2 * std::sin(a), std::sin(2 * a), 0);
    const Vec3 side = Vec3(-2 * std::cos(2 * a), 2 * std::cos(a), 0).normalized();
    return Vec3(centre + 0.2 * (std::cos(b) * side + std::sin(b) * Vec3::UnitZ()));
  });
}

Shape sheet() {
  return grid(12, 12, false, false,
              [](double u, double v) { return Vec3(u, v, 0.1 * std::sin(5 * u) * std::sin(4 * v)); });
}

Shape tube() {
  return grid(24, 5, true, false,
              [](double u, double v) { return Vec3(std::cos(2 * M_PI * u), std::sin(2 * M_PI * u), v); });
}

std::vector<Row> no_surface() {
  const Shape cube = box();
  return {
      {"nothing", {}, "a shape without faces"},
      {"points alone", points(cube.positions, {}), "a shape without faces"},
      {"a corner beyond the points", with_face(cube, {0, 1, 8}), "found point 8 in face 6"},
      {"a corner far beyond the points", with_face(cube, {0, 1, 0xffffffff}), "found point 4294967295 in face 6"},
      {"faces without points", points({}, {{0, 1, 2}}), "over 0 points, found point 0 in face 0"},
      {"a point that is not a number", with_point(cube, 7, {0, nan_value, 0}), "others in 3 faces: 1, 3, 5"},
      {"an infinite point", with_point(cube, 0, {0, 0, -infinite}), "others in 3 faces: 0, 2, 4"},
      {"all points not numbers", moved(cube, [](const Vec3&) { return Vec3(nan_value, 0, 0); }),
       "0, 1, 2, 3, 4 and 1 more"},
      {"too large for its squares", moved(cube, [](const Vec3& p) { return Vec3(p * 1e200); }),
       "between 1e-100 and 1e100, found inf"},
      {"too small for its squares", moved(cube, [](const Vec3& p) { return Vec3(p * 1e-200); }),
       "between 1e-100 and 1e100, found 0"},
      {"one triangle", points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), "3 corners in different places"},
      {"a triangle and its back", points({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}}), "3 corners in"},
      {"one point many times", moved(cube, [](const Vec3&) { return Vec3(1, 2, 3); }), "faces that have no area"},
      {"faces of two corners", points(cube.positions, {{0, 1}, {1, 2}, {2, 0}}), "faces that have no area"},
      {"faces of no corner", points(cube.positions, {{}, {}}), "faces that have no area"},
      {"faces of one corner again and again", points(cube.positions, {{0, 0, 0}, {1, 1, 1, 1}}),
       "faces that have no area"},
      {"a quad", points({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}}), "all lie in one plane"},
      {"a flat box", moved(cube, [](const Vec3& p) { return Vec3(p.x(), p.y() + p.z() / 3, 2); }),
       "all lie in one plane"},
      {"a box on a line", moved(cube, [](const Vec3& p) { return Vec3(p.sum() * Vec3(1, 2, 3)); }),
       "all lie on one line"},
      {"a box thinner than can be told", box({0, 0, 0}, {1, 1, 1e-11}), "all lie in one plane"},
  };
}

std::vector<Row> open() {
  const Shape cube = box(), ball = sphere();
  Shape far = without(cube, {1});
  far.origin = {5400000, 0, 100};
  return {
      {"a tetrahedron without a face", without(tetrahedron(), {3}),
       "a hole of 3 edges around (0.333333, 0.333333, 0.333333)"},
      {"a box without its lid", without(cube, {1}), "a hole of 4 edges around (0.5, 0.5, 1)"},
      {"a box without its lid far away", far, "a hole of 4 edges around (5.4e+06, 0.5, 101)"},
      {"a tunnel", without(cube, {0, 1}), "2 holes, the largest of 4 edges around (0.5, 0.5, "},
      {"a tube", tube(), "2 holes, the largest of 24 edges around (0, 0, 0)"},
      {"a ball without a face", without(ball, {100}), "a hole of 3 edges around ("},
      {"a ball without its pole",
       with_faces(ball, [&](std::size_t f) { return f < ball.faces.size() - 64 || f % 2 == 0; }), "a hole of 32 edges"},
      {"a sheet", sheet(), "a hole of 44 edges around ("},
      {"a sheet twice", both(sheet(), sheet()), "a hole of 44 edges around ("},
      {"a sheet and its back", both(sheet(), inside_out(sheet())), "a hole of 44 edges around ("},
      {"a strip with one side", moebius_strip(), "a hole of 80 edges"},
      {"loose triangles", random_triangles(50), "50 holes, the largest of 3 edges around ("},
      {"a quad crossed over", with_face(without(cube, {1}), {4, 7, 5, 6}),
       "1 edge of more: between points 4 and 5 in 2 faces: 1, 5, at"},
      {"an edge cut on one side only",
       with_face(with_point(both(without(cube, {1}), points({{0, 0, 0}}, {})), 8, {0.5, 0, 1}), {4, 8, 5, 7, 6}),
       "a hole of 3 edges around (0.5, 0, 1)"},
      {"a hole larger than may be closed", without(cube, {1}), "(close_holes 4)", {.close_holes = 3}},
      {"holes of which one may be closed", without(ball, {100, 101, 300}), "a hole of 4 edges", {.close_holes = 3}},
  };
}

std::vector<Row> not_manifold() {
  const Shape cube = box();
  const Vec3 one = Vec3::Ones();
  return {
      {"boxes that share an edge", both(cube, box({1, 1, 0}, {2, 2, 1})), "1 edge of more: between points 3 and 7"},
      {"boxes that share a face", both(cube, box({1, 0, 0}, {2, 1, 1})),
       "4 edges of more: the first between points 1 and 3"},
      {"a box with a wall inside", with_face(cube, {0, 1, 7, 6}), "edges of more"},
      {"a box with a fin", with_face(both(cube, points({{0.5, -1, 2}}, {})), {4, 5, 8}),
       "in 3 faces: 1, 2, 6, at (0, 0, 1)"},
      {"a bottle with one side", klein_bottle(40, 20), "a one-sided surface around (-2, 0, 0)"},
      {"boxes in boxes along an edge", both(both(cube, box(one, 2 * one)), box({1, 1, 0}, {2, 2, 1})), "edges of more"},
  };
}

std::vector<Row> crossing() {
  const Shape cube = box(), ball = sphere();
  const Vec3 half(0.5, 0.5, 0.5);
  Shape spike = both(without(cube, {1}), box({0.4, 0.4, 0.5}, {0.6, 0.6, 2}));
  const TetMeshOptions coarse{.vertices = 200};
  return {
      {"boxes that overlap", both(cube, box(half, 3 * half)), "found crossings of 6 faces: "},
      {"boxes all but in the same place",
       both(cube, moved(cube, [](const Vec3& p) { return Vec3(p + Vec3(1e-3, 2e-3, 3e-3)); })), " faces: "},
      {"a ball through a ring", both(torus(), sphere({1, 0, 0}, 0.6)), " faces: "},
      {"a box turned through itself", with_point(cube, 7, {0.5, 0.5, -0.5}), "found crossings of "},
      {"a tube through itself", crossing_tube(), " faces: "},
      {"boxes whose sides overlap in a plane", both(cube, box({1, 0.5, 0.5}, {2, 1.5, 1.5})), "found crossings of "},
      {"a box on a smaller one", both(cube, box({0.2, 0.2, 1}, {0.8, 0.8, 2})), "found crossings of "},
      {"a box whose edge lies in the other's side",
       both(cube,
            moved(cube, [](const Vec3& p) { return Vec3(1 + p.x() + p.y(), 0.5 + 0.1 * (p.x() - p.y()), p.z()); })),
       "found crossings of "},
      {"a cavity that breaks through", both(cube, inside_out(box({0.2, 0.2, 0.2}, {1.2, 0.8, 0.8}))),
       "found crossings of "},
      {"a spike through a hole that is closed", spike, "found crossings of ", {.close_holes = 4}},
      {"balls that overlap, decimated", both(ball, sphere({0.5, 0, 0})), " faces: ", coarse},
      {"a ring through a ring, decimated", both(torus(), sphere({1, 0, 0}, 0.6)), " faces: ", coarse},
  };
}

std::vector<Row> limits() {
  return {
      {"no time", sphere(), "within 0 seconds, found none", {.max_seconds = 0}},
      {"less than no time", sphere(), "within 0 seconds, found none", {.max_seconds = -5}},
#ifndef SINEW_SANITIZED  // which knows no limit of memory
      {"no memory", sphere(), "within 0 MiB of memory", {.max_bytes = 0}},
      {"too little memory", torus(1000, 200), "within 64 MiB of memory", {.vertices = 10000000, .max_bytes = 64 << 20}},
#endif
      {"too little time", torus(1000, 400), "within 1 seconds", {.vertices = 10000000, .max_seconds = 1}},
  };
}

std::string outcome(const Row& row) {
  std::vector<std::string> notes;
  try {
    const auto mesh = tetrahedralized(row.shape, row.options, notes);
    return mesh ? std::to_string(mesh->tets.size()) + " tets" : "nothing";
  } catch (const InputError& error) {
    return error.what();
  }
}

void check(const std::vector<Row>& rows) {
  for (const Row& row : rows) {
    const std::string said = outcome(row);
    EXPECT_NE(said.find(row.sentence), std::string::npos) << row.name << ": " << said;
    EXPECT_TRUE(said.find("expected ") != std::string::npos && said.find("found ") != std::string::npos)
        << row.name << ": " << said;
    EXPECT_TRUE(said.size() < 300 && said.find('\n') == std::string::npos) << row.name << ": " << said;
  }
}

}  // namespace

TEST(TetHostile, NoSurface) {
  check(no_surface());
}

TEST(TetHostile, Open) {
  check(open());
}

TEST(TetHostile, NotManifold) {
  check(not_manifold());
}

TEST(TetHostile, Crossing) {
  check(crossing());
}

TEST(TetHostile, Limits) {
  check(limits());
}

TEST(TetHostile, SpoiltAtRandom) {
  // Tets that hold what they promise, or a sentence.
  std::size_t filled = 0, crossing = 0, others = 0;
  for (std::uint64_t i = 0; i < 300; ++i) {
    Shape shape = i % 2 ? sphere(Vec3::Zero(), 1, 12, 5) : torus(12, 6);
    auto draw = [&, count = std::uint64_t{0}](std::size_t below) mutable {
      return static_cast<Index>(random_unit(i, count++) * static_cast<double>(below));
    };
    for (std::uint64_t k = 0; k < 1 + i % 4; ++k) {
      Vec3& p = shape.positions[draw(shape.size())];
      switch (draw(6)) {
        case 0: p *= 0.2 + 0.1 * draw(20); break;
        case 1: p = shape.positions[draw(shape.size())]; break;
        case 2: p = (p + shape.positions[draw(shape.size())]) / 2; break;
        case 3: p.z() = 0; break;
        case 4: shape.faces.points[draw(shape.faces.points.size())] = draw(shape.size()); break;
        default: p += 1e-9 * Vec3(draw(3), draw(3), draw(3)); break;
      }
    }
    std::vector<std::string> notes;
    try {
      const TetMesh mesh = tetrahedralized(shape, {.inside = i % 3 == 0, .close_holes = 8}, notes).value();
      for (const auto& [a, b, c, d] : mesh.tets)
        EXPECT_GT(tet_volume(mesh.vertices[a], mesh.vertices[b], mesh.vertices[c], mesh.vertices[d]), 0) << i;
      ++filled;
    } catch (const InputError& error) {
      const std::string said = error.what();
      EXPECT_TRUE(said.starts_with("expected ")) << said;
      EXPECT_EQ(said.find("it was ended by"), std::string::npos) << i << ": " << said;
      ++(said.find("cross") != std::string::npos ? crossing : others);
    }
  }
  EXPECT_GT(filled, 30u);
  EXPECT_GT(crossing, 30u);
  EXPECT_GT(others, 30u);
  fflush(stdout);
}

TEST(TetHostile, TheTableIsLong) {
  EXPECT_GE(no_surface().size() + open().size() + not_manifold().size() + crossing().size() + limits().size(), 55u);
}

TEST(TetHostile, ABoxWouldNotPass) {
  EXPECT_EQ(outcome({"box", box(), ""}).find("expected"), std::string::npos) << "a mesh that is fine is not refused";
}

}  // namespace sinew
