#include "apps/samples/dense.h"

#include <Eigen/Geometry>
#include <bit>
#include <cmath>
#include <cstring>
#include <span>
#include <vector>

#include "apps/samples/animal.h"
#include "apps/samples/random.h"
#include "apps/samples/scanner.h"
#include "engine/geometry/parallel.h"
#include "engine/io/output_file.h"

namespace sinew::samples {

namespace {

static_assert(std::endian::native == std::endian::little, "the values are written as they lie in memory");

constexpr std::size_t seeds = 40'000;   ///< points of the scan that others are strewn around
constexpr double strewn = 0.015;        ///< how far from them
constexpr std::size_t block = 1 << 20;  ///< points written at a time

/// Point i: near a point of the scan, moved along its normal onto the surface. A place from which that does not arrive
/// (a point in the air, the far side of an ear) gives way to the next one.
void make_point(const Shape& scan, const Random& random, float* out, bool with_normal) {
  const Implicit& skin = animal();
  const Attribute& normal = scan.attributes[0];
  for (std::uint64_t attempt = 0;; ++attempt) {
    const auto i = static_cast<std::size_t>(random.uniform(3 * attempt) * double(scan.size()));
    const Vec3 n(normal.number(i, 0), normal.number(i, 1), normal.number(i, 2));
    const Vec3 u = n.unitOrthogonal(), v = n.cross(u);
    const Vec3 start = scan.positions[i] + strewn * (2 * random.uniform(3 * attempt + 1) - 1) * u +
                       strewn * (2 * random.uniform(3 * attempt + 2) - 1) * v;
    const Implicit::Parts parts = skin.near_point(start, 0.01);
    if (parts.empty()) continue;
    Vec3 p = start;
    double d = skin.distance(p, parts);
    for (int step = 0; step < 8 && std::abs(d) > 2e-6; ++step) {
      p -= d * n;
      d = skin.distance(p, parts);
    }
    if (std::abs(d) > 2e-6 || (p - start).squaredNorm() > 1e-4) continue;
    for (int c = 0; c < 3; ++c) out[c] = static_cast<float>(p[c]);
    if (!with_normal) return;
    const Vec3 exact = skin.normal(p, parts);
    for (int c = 0; c < 3; ++c) out[3 + c] = static_cast<float>(exact[c]);
    return;
  }
}

std::string header_of(std::uint64_t points, bool normals) {
  std::string header = "ply\nformat binary_little_endian 1.0\ncomment a giraffe made by sinew-samples, metres\n";
  header += "element vertex " + std::to_string(points) + "\n";
  for (const char* name : {"x", "y", "z", "nx", "ny", "nz"})
    if (normals || std::strlen(name) == 1) header += std::string("property float ") + name + "\n";
  return header + "end_header\n";
}

}  // namespace

void write_dense_animal(const std::string& path, std::uint64_t points, bool normals, std::uint64_t seed) {
  const Shape scan = sample_animal(seeds, seed);
  io::OutputFile file(path, true);
  const std::string header = header_of(points, normals);
  file.write(std::as_bytes(std::span(header)));
  const std::size_t row = normals ? 6 : 3;
  std::vector<float> values;
  for (std::uint64_t first = 0; first < points; first += block) {
    const std::size_t count = static_cast<std::size_t>(std::min<std::uint64_t>(block, points - first));
    values.resize(count * row);
    parallel_for(count, 4096, [&](std::size_t begin, std::size_t end) {
      for (std::size_t i = begin; i < end; ++i) make_point(scan, Random(seed, first + i), &values[i * row], normals);
    });
    file.write(std::as_bytes(std::span(values)));
  }
  file.commit();
}

}  // namespace sinew::samples
