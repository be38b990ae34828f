#include "apps/samples/scanner.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "apps/samples/animal.h"
#include "apps/samples/attributes.h"
#include "apps/samples/random.h"
#include "engine/geometry/parallel.h"

namespace sinew::samples {

namespace {

constexpr double none = std::numeric_limits<double>::infinity();
constexpr double standoff = 3.5;       ///< of the scanner from the middle of the animal
constexpr double baseline = 0.5;       ///< of its camera from its laser
constexpr double noise = 0.0004;       ///< deviation of a range
constexpr double edge_depth = 0.04;    ///< ranges of neighbouring rays that differ by more lie on two surfaces
constexpr double edge_behind = 0.25;   ///< what a ray past an edge measures where nothing is behind it, at most
constexpr double edge_rate = 0.012;    ///< of rays beside an edge that give a point in the air
constexpr double stray_rate = 0.0004;  ///< of rays that give a point anywhere near

/// Where the scanner stands, seen from the middle of the animal: around it level, from above, from below, and on top.
constexpr double places[][3] = {{1, .15, 0},     {.7, .15, .7}, {0, .15, 1},    {-.7, .15, .7},  {-1, .15, 0},
                                {-.7, .15, -.7}, {0, .15, -1},  {.7, .15, -.7}, {.9, .6, .4},    {.4, .6, .9},
                                {-.4, .6, .9},   {-.9, .6, .4}, {-.9, .6, -.4}, {-.4, .6, -.9},  {.4, .6, -.9},
                                {.9, .6, -.4},   {.8, -.2, .5}, {-.8, -.2, .5}, {-.8, -.2, -.5}, {.8, -.2, -.5},
                                {.3, 1, .1},     {-.4, 1, -.1}};
constexpr std::size_t place_count = std::size(places);

struct Measured {
  Vec3 p;
  Vec3 normal;
  float intensity = 0, confidence = 0;
  float light = 0;  ///< that the skin gives back, without the angle
};

/// The rays of one place: ray (row, column) goes from `eye` through corner + column du + row dv.
struct Rays {
  Vec3 eye, corner, du, dv;
  int columns = 0, rows = 0;
  double near = 0, far = 0;

  Vec3 direction(int row, int column) const { return (corner + column * du + row * dv - eye).normalized(); }
};

Rays rays_from(std::size_t place, double pitch) {
  const Bounds& bounds = animal().bounds();
  const Vec3 target = bounds.centre();
  const Vec3 back = Vec3(places[place][0], places[place][1], places[place][2]).normalized();
  const Vec3 right = Vec3::UnitY().cross(back).normalized();
  const Vec3 up = back.cross(right);
  Rays rays;
  rays.eye = target + standoff * back;
  rays.near = standoff - 0.6 * bounds.diagonal();
  rays.far = standoff + 0.6 * bounds.diagonal();
  // The window of the plane through the target that shows the whole box.
  double half_width = 0, half_height = 0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner(i & 1 ? bounds.max.x() : bounds.min.x(), i & 2 ? bounds.max.y() : bounds.min.y(),
                      i & 4 ? bounds.max.z() : bounds.min.z());
    const double scale = standoff / (standoff - (corner - target).dot(back));
    half_width = std::max(half_width, scale * std::abs((corner - target).dot(right)));
    half_height = std::max(half_height, scale * std::abs((corner - target).dot(up)));
  }
  rays.columns = static_cast<int>(std::ceil(2 * half_width / pitch)) + 1;
  rays.rows = static_cast<int>(std::ceil(2 * half_height / pitch)) + 1;
  rays.du = pitch * right;
  rays.dv = -pitch * up;
  rays.corner = target - half_width * right + half_height * up;
  return rays;
}

/// What one place measures, row by row; `range` is `none` where it measures nothing.
struct Grid {
  Rays rays;
  std::vector<double> surface;  ///< range of the surface itself
  std::vector<double> range;    ///< the one measured
  std::vector<float> intensity, light;
  std::vector<char> in_air;

  std::size_t index(int row, int column) const {
    return static_cast<std::size_t>(row) * static_cast<std::size_t>(rays.columns) + static_cast<std::size_t>(column);
  }
  bool inside(int row, int column) const { return row >= 0 && column >= 0 && row < rays.rows && column < rays.columns; }
  Vec3 point(int row, int column) const { return rays.eye + range[index(row, column)] * rays.direction(row, column); }
};

/// Meets ray (row, column) with the surface, and decides what the scanner sees of it.
void shoot(Grid& grid, int row, int column, const Random& random) {
  const Implicit& skin = animal();
  const Rays& rays = grid.rays;
  const std::size_t i = grid.index(row, column);
  const Vec3 direction = rays.direction(row, column);
  const Implicit::Parts parts = skin.near_ray(rays.eye, direction);
  const double t = skin.trace(rays.eye, direction, rays.near, rays.far, parts);
  grid.surface[i] = t;
  if (t == none) return;

  const Vec3 p = rays.eye + t * direction;
  const Vec3 normal = skin.normal(p, parts);
  const double cosine = -normal.dot(direction);
  const double light = reflectance(p, skin.material(p, parts));
  const double seen = std::clamp((cosine - 0.10) / 0.25, 0.0, 1.0) * std::clamp((light - 0.02) / 0.12, 0.0, 1.0);
  if (random.uniform(0) >= seen) return;

  const Vec3 camera = rays.eye + baseline * rays.du.normalized();
  const Vec3 way = camera - p;
  const Vec3 to_camera = way.normalized();
  const Vec3 start = p + 2e-3 * normal;
  if (skin.trace(start, to_camera, 0, way.norm(), skin.near_ray(start, to_camera)) != none) return;

  grid.range[i] = t + noise * random.normal(1);
  grid.intensity[i] = static_cast<float>(light * (0.4 + 0.6 * std::max(cosine, 0.0)));
  grid.light[i] = static_cast<float>(light);
}

/// Points in the air: behind edges, and strays.
void add_air(Grid& grid, int row, int column, const Random& random) {
  const std::size_t i = grid.index(row, column);
  const double t = grid.surface[i];
  if (t == none) return;
  double behind = 0;  // how far behind this point the farthest neighbour lies
  for (const auto& [r, c] : {std::pair(row - 1, column), {row + 1, column}, {row, column - 1}, {row, column + 1}}) {
    const double next = grid.inside(r, c) ? grid.surface[grid.index(r, c)] : none;
    behind = std::max(behind, std::min(next - t, edge_behind));
  }
  double depth = 0;
  if (behind > edge_depth && random.uniform(20) < edge_rate) depth = behind * (0.1 + 0.9 * random.uniform(21));
  if (random.uniform(22) < stray_rate) depth = 0.4 * (random.uniform(23) - 0.5);
  if (depth == 0) return;
  grid.range[i] = t + depth;
  grid.intensity[i] = static_cast<float>(0.05 + 0.3 * random.uniform(24));
  grid.light[i] = grid.intensity[i];
  grid.in_air[i] = 1;
}

/// The normal of measured point (row, column) from its neighbours in the grid, towards the scanner; the ray backwards
/// where it has too few.
Vec3 grid_normal(const Grid& grid, int row, int column) {
  const Vec3 p = grid.point(row, column);
  Vec3 back = -grid.rays.direction(row, column);
  const double gate = 4 * grid.rays.du.norm();
  const auto slope = [&](int dr, int dc) -> Vec3 {
    Vec3 ends[2] = {p, p};
    for (const int side : {0, 1}) {
      const int r = row + (side == 0 ? -dr : dr), c = column + (side == 0 ? -dc : dc);
      if (!grid.inside(r, c) || grid.range[grid.index(r, c)] == none) continue;
      if (const Vec3 q = grid.point(r, c); (q - p).norm() < gate) ends[side] = q;
    }
    return ends[1] - ends[0];
  };
  const Vec3 normal = slope(1, 0).cross(slope(0, 1));
  const double length = normal.norm();
  if (length == 0) return back;
  return normal.dot(back) < 0 ? Vec3(-normal / length) : Vec3(normal / length);
}

/// Everything that is measured from one place.
std::vector<Measured> scan_from(std::size_t place, double pitch, std::uint64_t seed) {
  Grid grid{rays_from(place, pitch), {}, {}, {}, {}, {}};
  const int rows = grid.rays.rows, columns = grid.rays.columns;
  const std::size_t count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(columns);
  grid.surface.assign(count, none);
  grid.range.assign(count, none);
  grid.intensity.assign(count, 0);
  grid.light.assign(count, 0);
  grid.in_air.assign(count, 0);

  const auto each_ray = [&](const auto& body) {
    parallel_for(static_cast<std::size_t>(rows), 4, [&](std::size_t begin, std::size_t end) {
      for (int row = static_cast<int>(begin); row < static_cast<int>(end); ++row)
        for (int column = 0; column < columns; ++column) body(row, column);
    });
  };
  const auto random = [&](int row, int column) { return Random(seed, place, grid.index(row, column)); };
  each_ray([&](int row, int column) { shoot(grid, row, column, random(row, column)); });
  each_ray([&](int row, int column) { add_air(grid, row, column, random(row, column)); });

  std::vector<Measured> found;
  for (int row = 0; row < rows; ++row)
    for (int column = 0; column < columns; ++column) {
      const std::size_t i = grid.index(row, column);
      if (grid.range[i] == none) continue;
      Measured point{grid.point(row, column), grid_normal(grid, row, column), grid.intensity[i], 0, grid.light[i]};
      const double cosine = -point.normal.dot(grid.rays.direction(row, column));
      point.confidence = static_cast<float>(grid.in_air[i] ? 0.1 * cosine : cosine);
      found.push_back(point);
    }
  return found;
}

/// All scans at a pitch (metres between rays at the middle of the animal).
std::vector<std::vector<Measured>> scan_all(double pitch, std::uint64_t seed) {
  std::vector<std::vector<Measured>> scans;
  for (std::size_t place = 0; place < place_count; ++place) scans.push_back(scan_from(place, pitch, seed));
  return scans;
}

std::size_t count_of(const std::vector<std::vector<Measured>>& scans) {
  std::size_t count = 0;
  for (const auto& scan : scans) count += scan.size();
  return count;
}

}  // namespace

Shape sample_animal(std::size_t points, std::uint64_t seed) {
  CHECK(points >= 1000, points);
  // The number of points goes with 1 / pitch^2: one coarse scan tells the pitch of the wanted one.
  constexpr double coarse = 0.04;
  double pitch = coarse * std::sqrt(double(count_of(scan_all(coarse, seed))) / (1.01 * double(points)));
  std::vector<std::vector<Measured>> scans = scan_all(pitch, seed);
  for (; count_of(scans) < points; scans = scan_all(pitch, seed)) pitch *= 0.99;

  const std::size_t found = count_of(scans);
  Shape shape;
  shape.position_type = Type::Float32;
  shape.positions.reserve(points);
  Attribute normal = make_attribute("normal", {"nx", "ny", "nz"}, Kind::Normal, Type::Float32, points);
  Attribute color = make_attribute("color", {"red", "green", "blue"}, Kind::Color, Type::UInt8, points);
  Attribute intensity = make_attribute("intensity", {"intensity"}, Kind::Scalar, Type::Float32, points);
  Attribute confidence = make_attribute("confidence", {"confidence"}, Kind::Scalar, Type::Float32, points);
  Attribute scan_number = make_attribute("scan", {"scan"}, Kind::Id, Type::UInt8, points);
  std::size_t k = 0;
  for (std::size_t place = 0; place < place_count; ++place)
    for (const Measured& point : scans[place]) {
      // Of the `found` points every one but found - points, evenly.
      const std::size_t i = shape.size();
      const bool kept = (k + 1) * points / found > k * points / found;
      ++k;
      if (!kept) continue;
      shape.positions.push_back(point.p.cast<float>().cast<double>());
      for (int c = 0; c < 3; ++c) normal.set_number(i, c, point.normal[c]);
      for (int c = 0; c < 3; ++c) color.set_number(i, c, skin_color(point.light)[c]);
      intensity.set_number(i, 0, point.intensity);
      confidence.set_number(i, 0, point.confidence);
      scan_number.set_number(i, 0, double(place));
    }
  CHECK(shape.size() == points, shape.size(), points);
  shape.attributes = {std::move(normal), std::move(color), std::move(intensity), std::move(confidence),
                      std::move(scan_number)};
  return shape;
}

}  // namespace sinew::samples
