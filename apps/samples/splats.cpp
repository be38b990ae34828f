#include "apps/samples/splats.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/samples/animal.h"
#include "apps/samples/attributes.h"
#include "apps/samples/random.h"
#include "engine/geometry/parallel.h"

namespace sinew::samples {

namespace {

constexpr double shell = 0.01;  ///< half the thickness of the layer that points are drawn from
constexpr double pi = 3.14159265358979323846;

struct Place {
  Vec3 p, normal;
  int material = 0;
  std::uint64_t next = 0;  ///< the first of the splat's random numbers that its place did not use
};

/// Points drawn evenly from a layer of the same thickness everywhere, moved onto the surface, cover it evenly.
Place draw_place(const Random& random) {
  const Implicit& skin = animal();
  const Vec3 low = skin.bounds().min - Vec3::Constant(shell);
  const Vec3 size = skin.bounds().max + Vec3::Constant(shell) - low;
  for (std::uint64_t attempt = 0;; ++attempt) {
    const Vec3 part(random.uniform(3 * attempt), random.uniform(3 * attempt + 1), random.uniform(3 * attempt + 2));
    Vec3 p = low + size.cwiseProduct(part);
    const Implicit::Parts parts = skin.near_point(p, 2 * shell);
    if (parts.empty()) continue;
    double d = skin.distance(p, parts);
    if (std::abs(d) > shell) continue;
    for (int step = 0; step < 8 && std::abs(d) > 1e-5; ++step) {
      p -= d * skin.normal(p, parts);
      d = skin.distance(p, parts);
    }
    if (std::abs(d) > 1e-5) continue;
    return {p, skin.normal(p, parts), skin.material(p, parts), 3 * attempt + 3};
  }
}

/// The functions of bands 1 to 3 with the order and signs of 3D Gaussian splatting, times 4 pi / (2 l + 1): by the
/// addition theorem coefficients g_l * lobe_along(axis) show sum_l g_l P_l(axis . d) along d.
std::array<double, 15> lobe_along(const Vec3& axis) {
  const double x = axis.x(), y = axis.y(), z = axis.z();
  const double one = std::sqrt(3 / (4 * pi)), two = std::sqrt(15 / (4 * pi));
  const double three = std::sqrt(35 / (32 * pi)), four = std::sqrt(21 / (32 * pi)), five = std::sqrt(105 / (4 * pi));
  const double r = x * x + y * y + z * z;
  std::array<double, 15> lobe{-one * y,
                              one * z,
                              -one * x,
                              two * x * y,
                              -two * y * z,
                              std::sqrt(5 / (16 * pi)) * (3 * z * z - r),
                              -two * x * z,
                              two / 2 * (x * x - y * y),
                              -three * y * (3 * x * x - y * y),
                              five * x * y * z,
                              -four * y * (5 * z * z - r),
                              std::sqrt(7 / (16 * pi)) * z * (5 * z * z - 3 * r),
                              -four * x * (5 * z * z - r),
                              five / 2 * z * (x * x - y * y),
                              -three * x * (x * x - 3 * y * y)};
  for (std::size_t k = 0; k < lobe.size(); ++k) lobe[k] *= 4 * pi / (k < 3 ? 3 : k < 8 ? 5 : 7);
  return lobe;
}

struct Splats {
  Attribute normal, dc, rest, opacity, scale, rot;

  explicit Splats(std::size_t n)
      : normal(make_attribute("normal", {"nx", "ny", "nz"}, Kind::Normal, Type::Float32, n)),
        dc(make_attribute("f_dc", numbered("f_dc_", 3), Kind::SphericalHarmonics, Type::Float32, n)),
        rest(make_attribute("f_rest", numbered("f_rest_", 45), Kind::SphericalHarmonics, Type::Float32, n)),
        opacity(make_attribute("opacity", {"opacity"}, Kind::Scalar, Type::Float32, n)),
        scale(make_attribute("scale", numbered("scale_", 3), Kind::LogScale, Type::Float32, n)),
        rot(make_attribute("rot", numbered("rot_", 4), Kind::Quaternion, Type::Float32, n)) {}

  static std::vector<std::string> numbered(const std::string& name, int count) {
    std::vector<std::string> out;
    for (int i = 0; i < count; ++i) out.push_back(name + std::to_string(i));
    return out;
  }

  void set(std::size_t i, const Place& place, const Random& random) {
    set_shape(i, place, random);
    set_colour(i, place);
    opacity.set_number(i, 0, 3 + random.uniform(place.next));
  }

  /// Longer along the coat's hair, which lies downwards.
  void set_shape(std::size_t i, const Place& place, const Random& random) {
    const Vec3& n = place.normal;
    Vec3 hair = -Vec3::UnitY() + n * n.y();
    hair = hair.squaredNorm() > 1e-6 ? Vec3(hair.normalized()) : n.unitOrthogonal();
    Mat3 R;
    R << hair, n.cross(hair), n;
    const Eigen::Quaterniond q(R);
    const double wxyz[] = {q.w(), q.x(), q.y(), q.z()};
    for (int c = 0; c < 4; ++c) rot.set_number(i, c, wxyz[c]);
    // exp(-5) is 7 mm: about the distance of neighbours, 30,000 on 1.9 square metres. exp(-8) is a third of one.
    const double sizes[] = {-4.9, -5.2, -8};
    for (std::uint64_t c = 0; c < 3; ++c)
      scale.set_number(i, static_cast<int>(c), sizes[c] + 0.3 * (random.uniform(place.next + 1 + c) - 0.5));
  }

  void set_colour(std::size_t i, const Place& place) {
    const Vec3 sun = Vec3(0.5, 0.8, 0.35).normalized();
    const double light = place.normal.dot(sun);
    const Vec3 coat = skin_color(reflectance(place.p, place.material)) / 255;
    const Vec3 shown = coat * (0.62 + 0.38 * std::max(light, -0.5));
    const double band0 = std::sqrt(1 / (4 * pi));
    for (int c = 0; c < 3; ++c) dc.set_number(i, c, (shown[c] - 0.5) / band0);
    if (light <= 0) return;
    // A viewer looks along d, from the eye to the splat: the reflection is seen where d is opposite to where it leads.
    const Vec3 reflected = 2 * light * place.normal - sun;
    const std::array<double, 15> lobe = lobe_along(-reflected);
    const Vec3 warm(0.30, 0.27, 0.22);
    for (int c = 0; c < 3; ++c)
      for (int k = 0; k < 15; ++k) {
        const double share = k < 3 ? 0.45 : k < 8 ? 0.35 : 0.20;
        rest.set_number(i, 15 * c + k, warm[c] * light * share * lobe[static_cast<std::size_t>(k)]);
      }
  }
};

}  // namespace

Shape sample_splats(std::size_t count, std::uint64_t seed) {
  Shape shape;
  shape.position_type = Type::Float32;
  shape.positions.resize(count);
  Splats splats(count);
  parallel_for(count, 256, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) {
      const Random random(seed, i);
      const Place place = draw_place(random);
      shape.positions[i] = place.p.cast<float>().cast<double>();
      splats.set(i, place, random);
    }
  });
  shape.attributes = {std::move(splats.normal),  std::move(splats.dc),    std::move(splats.rest),
                      std::move(splats.opacity), std::move(splats.scale), std::move(splats.rot)};
  return shape;
}

}  // namespace sinew::samples
