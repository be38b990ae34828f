#include "apps/samples/animal.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/samples/random.h"

namespace sinew::samples {

namespace {

constexpr int coat = static_cast<int>(Material::Coat);
constexpr int pale = static_cast<int>(Material::Pale);
constexpr int dark = static_cast<int>(Material::Dark);
constexpr int black = static_cast<int>(Material::Black);

using Capsules = std::vector<Capsule>;

struct Knot {
  Vec3 p;
  double r;
};

/// Capsules from knot to knot.
void add_chain(Capsules& parts, std::initializer_list<Knot> knots, double blend, double flat = 1, int material = coat) {
  for (const Knot* knot = knots.begin(); knot + 1 != knots.end(); ++knot)
    parts.push_back({knot[0].p, knot[1].p, knot[0].r, knot[1].r, blend, Vec3::UnitZ(), flat, material});
}

void add_body(Capsules& parts) {
  add_chain(parts, {{{0.19, 0.94, 0}, 0.178}, {{-0.02, 0.875, 0}, 0.182}, {{-0.26, 0.895, 0}, 0.150}}, 0.08, 0.84);
  add_chain(parts, {{{0.22, 1.05, 0}, 0.075}, {{0.04, 1.00, 0}, 0.070}}, 0.10);
  add_chain(parts, {{{0.27, 0.92, 0}, 0.11}, {{0.29, 0.84, 0}, 0.085}}, 0.08, 0.8);
}

/// The quadratic curve of three points.
Vec3 bezier(const std::array<Vec3, 3>& p, double t) {
  return (1 - t) * (1 - t) * p[0] + 2 * t * (1 - t) * p[1] + t * t * p[2];
}

void add_neck(Capsules& parts) {
  const std::array<Vec3, 3> spine{Vec3(0.22, 0.99, 0), Vec3(0.42, 1.22, 0), Vec3(0.585, 1.87, 0)};
  constexpr int segments = 6;
  const auto radius = [](double t) { return 0.137 - 0.132 * t + 0.052 * t * t; };
  for (int i = 0; i < segments; ++i) {
    const double t = double(i) / segments, u = double(i + 1) / segments;
    parts.push_back({bezier(spine, t), bezier(spine, u), radius(t), radius(u), 0.05, Vec3::UnitZ(), 0.84, coat});
  }
  // The mane: tufts along the back of the neck.
  constexpr int tufts = 30;
  for (int i = 0; i < tufts; ++i) {
    const double t = 0.10 + 0.88 * i / (tufts - 1);
    const Vec3 along = (bezier(spine, t + 0.01) - bezier(spine, t - 0.01)).normalized();
    const Vec3 back(-along.y(), along.x(), 0);
    const Vec3 root = bezier(spine, t) + 0.93 * radius(t) * back;
    parts.push_back({root, root + 0.026 * back + 0.012 * along, 0.016, 0.008, 0.010, Vec3::UnitZ(), 0.6, dark});
  }
  // Folds of the throat: rings that stand out a little.
  for (int i = 0; i < 5; ++i) {
    const double t = 0.74 + 0.05 * i;
    const Vec3 along = (bezier(spine, t + 0.01) - bezier(spine, t - 0.01)).normalized();
    const Vec3 front(along.y(), -along.x(), 0);
    const Vec3 c = bezier(spine, t) + 0.62 * radius(t) * front;
    parts.push_back({c - 0.028 * Vec3::UnitZ(), c + 0.028 * Vec3::UnitZ(), 0.41 * radius(t), 0.41 * radius(t), 0.010,
                     along, 0.35, coat});
  }
}

void add_head(Capsules& parts) {
  add_chain(parts, {{{0.585, 1.915, 0}, 0.070}, {{0.650, 1.905, 0}, 0.064}}, 0.04, 0.92);
  add_chain(parts, {{{0.630, 1.905, 0}, 0.060}, {{0.805, 1.815, 0}, 0.040}}, 0.03, 0.88);
  add_chain(parts, {{{0.620, 1.860, 0}, 0.042}, {{0.795, 1.785, 0}, 0.027}}, 0.02, 0.9);
  add_chain(parts, {{{0.810, 1.812, 0}, 0.042}, {{0.833, 1.798, 0}, 0.037}}, 0.02, 0.95, pale);
  for (const double side : {-1.0, 1.0}) {
    parts.push_back(
        {{0.852, 1.822, 0.021 * side}, {0.856, 1.818, 0.023 * side}, 0.012, 0.010, 0.006, Vec3::UnitZ(), 1, black});
    parts.push_back(
        {{0.658, 1.942, 0.040 * side}, {0.685, 1.932, 0.040 * side}, 0.024, 0.020, 0.02, Vec3::UnitZ(), 1, coat});
    parts.push_back(
        {{0.675, 1.922, 0.052 * side}, {0.678, 1.922, 0.052 * side}, 0.017, 0.017, 0.004, Vec3::UnitZ(), 1, black});
    // Ossicones with their knobs.
    add_chain(parts, {{{0.590, 1.960, 0.036 * side}, 0.020}, {{0.565, 2.050, 0.046 * side}, 0.014}}, 0.02);
    add_chain(parts, {{{0.564, 2.056, 0.0465 * side}, 0.021}, {{0.563, 2.062, 0.047 * side}, 0.020}}, 0.012, 1, dark);
    // Ears: leaves, flat along the direction that they listen to.
    const Vec3 root(0.560, 1.940, 0.060 * side), middle(0.535, 1.963, 0.120 * side), tip(0.512, 1.963, 0.185 * side);
    const Vec3 listen = Vec3(0.86, 0.50, 0.30 * side).normalized();
    parts.push_back({root, middle, 0.016, 0.036, 0.012, listen, 0.36, coat});
    parts.push_back({middle, tip, 0.036, 0.008, 0.010, listen, 0.36, coat});
  }
}

void add_legs(Capsules& parts) {
  for (const double side : {-1.0, 1.0}) {
    const auto at = [side](double x, double y, double z) { return Vec3(x, y, z * side); };
    // Front: shoulder, forearm, knee, shin, fetlock, hoof. The two stand a little apart, as an animal at rest does.
    const double step = 0.025 * side;
    add_chain(parts, {{at(0.21, 0.95, 0.085), 0.105}, {at(0.225 + step / 2, 0.72, 0.098), 0.068}}, 0.07);
    add_chain(parts, {{at(0.225 + step / 2, 0.74, 0.098), 0.066}, {at(0.24 + step, 0.42, 0.095), 0.038}}, 0.03);
    add_chain(parts, {{at(0.243 + step, 0.405, 0.095), 0.043}, {at(0.243 + step, 0.38, 0.095), 0.041}}, 0.02);
    add_chain(parts, {{at(0.24 + step, 0.39, 0.095), 0.034}, {at(0.237 + step, 0.09, 0.095), 0.026}}, 0.02, 1, pale);
    add_chain(parts, {{at(0.237 + step, 0.088, 0.095), 0.033}, {at(0.25 + step, 0.055, 0.095), 0.030}}, 0.02, 1, pale);
    add_chain(parts, {{at(0.255 + step, 0.030, 0.095), 0.040}, {at(0.265 + step, 0.012, 0.095), 0.044}}, 0.01, 1, dark);
    // Back: haunch, thigh, hock, cannon, fetlock, hoof.
    const double lag = -0.035 * side;
    add_chain(parts, {{at(-0.25, 0.90, 0.075), 0.112}, {at(-0.215 + lag / 2, 0.66, 0.092), 0.078}}, 0.07);
    add_chain(parts, {{at(-0.215 + lag / 2, 0.68, 0.092), 0.076}, {at(-0.305 + lag, 0.42, 0.092), 0.036}}, 0.03);
    add_chain(parts, {{at(-0.312 + lag, 0.42, 0.092), 0.038}, {at(-0.305 + lag, 0.385, 0.092), 0.036}}, 0.02);
    add_chain(parts, {{at(-0.303 + lag, 0.39, 0.092), 0.033}, {at(-0.285 + lag, 0.09, 0.092), 0.026}}, 0.02, 1, pale);
    add_chain(parts, {{at(-0.285 + lag, 0.088, 0.092), 0.033}, {at(-0.272 + lag, 0.055, 0.092), 0.030}}, 0.02, 1, pale);
    add_chain(parts, {{at(-0.267 + lag, 0.030, 0.092), 0.040}, {at(-0.257 + lag, 0.012, 0.092), 0.044}}, 0.01, 1, dark);
  }
}

void add_tail(Capsules& parts) {
  add_chain(parts,
            {{{-0.385, 0.985, 0}, 0.034},
             {{-0.445, 0.93, 0.005}, 0.022},
             {{-0.472, 0.80, 0.015}, 0.016},
             {{-0.480, 0.66, 0.030}, 0.013}},
            0.02);
  add_chain(parts, {{{-0.480, 0.66, 0.030}, 0.016}, {{-0.485, 0.57, 0.040}, 0.034}, {{-0.500, 0.46, 0.045}, 0.010}},
            0.015, 0.8, dark);
}

/// Distances from p to the two nearest of the points that lie one in each cell of a jittered unit grid, and a number of
/// the nearest's own.
struct Cells {
  double first = 1e9, second = 1e9;
  double number = 0;
};
Cells cells_at(const Vec3& p) {
  Cells cells;
  const Vec3 corner = p.array().floor();
  for (int i = 0; i < 27; ++i) {
    const int dx = i % 3 - 1, dy = i / 3 % 3 - 1, dz = i / 9 - 1;
    const Vec3 cell = corner + Vec3(dx, dy, dz);
    const auto key = [](double x) { return static_cast<std::uint64_t>(static_cast<std::int64_t>(x)); };
    const Random random(key(cell.x()), key(cell.y()), key(cell.z()));
    const Vec3 point = cell + Vec3(random.uniform(0), random.uniform(1), random.uniform(2));
    const double d = (p - point).norm();
    if (d < cells.first) {
      cells.second = cells.first;
      cells.first = d;
      cells.number = random.uniform(3);
    } else {
      cells.second = std::min(cells.second, d);
    }
  }
  return cells;
}

}  // namespace

const Implicit& animal() {
  static const Implicit surface = [] {
    Capsules parts;
    add_body(parts);
    add_neck(parts);
    add_legs(parts);
    add_head(parts);
    add_tail(parts);
    return Implicit(std::move(parts), true);
  }();
  return surface;
}

double reflectance(const Vec3& p, int material) {
  switch (static_cast<Material>(material)) {
    case Material::Black: return 0.03;
    case Material::Dark: return 0.20;
    case Material::Pale: return 0.86;
    case Material::Coat: break;
  }
  // Patches shrink down the legs and towards the head.
  const double size = p.y() < 0.6 || p.y() > 1.82 ? 0.055 : 0.095;
  const Cells cells = cells_at(p / size);
  const bool line = cells.second - cells.first < 0.16;
  if (line) return 0.90;
  if (cells.number < 0.05 && cells.first < 0.45) return 0.04;
  return 0.36 + 0.22 * cells.number;
}

Vec3 skin_color(double light) {
  const Vec3 black(24, 20, 18), brown(146, 88, 48), cream(238, 220, 186);
  const double t = std::clamp(light / 0.45, 0.0, 1.0), u = std::clamp((light - 0.45) / 0.45, 0.0, 1.0);
  return black + t * (brown - black) + u * (cream - brown);
}

}  // namespace sinew::samples
