#include "apps/samples/streams.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/samples/attributes.h"
#include "apps/samples/fluid.h"
#include "apps/samples/random.h"

namespace sinew::samples {

namespace {

constexpr double rate = 24;  ///< frames a second

Shape shape_of(const std::vector<Particle>& particles) {
  Shape shape;
  Attribute velocity = make_attribute("velocity", {"vx", "vy", "vz"}, Kind::Velocity, Type::Float32, particles.size());
  Attribute id = make_attribute("id", {"id"}, Kind::Id, Type::UInt32, particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    shape.positions.push_back(particles[i].x.cast<float>().cast<double>());
    for (int c = 0; c < 3; ++c) velocity.set_number(i, c, particles[i].v[c]);
    id.set_number(i, 0, particles[i].id);
  }
  shape.attributes = {std::move(velocity), std::move(id)};
  return shape;
}

/// A round nozzle: a layer of seven particles whenever the fluid has come a spacing further.
class Nozzle {
 public:
  Nozzle(double spacing, double speed) : spacing_(spacing), speed_(speed) {}

  /// What leaves it during a step: each as far as it has come by the step's beginning.
  void pour(Fluid& fluid, double dt) {
    ahead_ += dt * speed_;
    while (ahead_ >= spacing_) {
      ahead_ -= spacing_;
      pour_layer(fluid, ahead_);
    }
  }

 private:
  void pour_layer(Fluid& fluid, double ahead) {
    // About 62 degrees upwards; across and side complete it to a frame.
    const Vec3 mouth(0, 0.06, 0), along = Vec3(0.47, 0.88, 0).normalized(), across(-along.y(), along.x(), 0),
                                  side = Vec3::UnitZ();
    constexpr double half_root3 = 0.8660254037844386;
    constexpr std::array<std::array<double, 2>, 7> places{
        {{0, 0}, {1, 0}, {0.5, half_root3}, {-0.5, half_root3}, {-1, 0}, {-0.5, -half_root3}, {0.5, -half_root3}}};
    for (const auto& place : places) {
      const Random random(1, next_id_);
      const auto shaken = [&](std::uint64_t i) { return 2 * random.uniform(i) - 1; };
      Particle particle;
      particle.id = next_id_++;
      particle.x = mouth + (ahead + 0.1 * spacing_ * shaken(0)) * along +
                   1.15 * spacing_ * (place[0] + 0.05 * shaken(1)) * across +
                   1.15 * spacing_ * (place[1] + 0.05 * shaken(2)) * side;
      particle.v = speed_ * along + 0.12 * Vec3(shaken(3), shaken(4), shaken(5));
      fluid.add(particle);
    }
  }

  double spacing_, speed_, ahead_ = 0;
  std::uint32_t next_id_ = 0;
};

}  // namespace

void make_jet(int frames, const TakeFrame& take) {
  constexpr int steps_a_frame = 10;
  Fluid::Settings settings;
  settings.spacing = 0.03;
  settings.dt = 1 / (rate * steps_a_frame);
  settings.box.add(Vec3(-1, 0, -2));
  settings.box.add(Vec3(4, 2, 2));
  settings.grip = 0.05;
  settings.viscosity = 0.2;
  Fluid fluid(settings);
  Nozzle nozzle(settings.spacing, 3.9);
  constexpr int before = 40 * steps_a_frame;  ///< steps until as many die as are born
  for (int step = 0, frame = 1; frame <= frames; ++step) {
    nozzle.pour(fluid, settings.dt);
    fluid.step();
    if (step >= before && (step - before) % steps_a_frame == 0) take(frame++, shape_of(fluid.before_last_step()));
    fluid.remove_if(
        [](const Particle& particle) { return particle.age > 1.0 + 0.4 * Random(2, particle.id).uniform(0); });
  }
}

void make_dam_break(const std::array<int, 3>& column, int frames, const TakeFrame& take) {
  constexpr int steps_a_frame = 8;
  constexpr double spacing = 0.025;
  Fluid::Settings settings;
  settings.spacing = spacing;
  settings.dt = 1 / (rate * steps_a_frame);
  settings.iterations = 2;
  settings.viscosity = 0.1;
  settings.box.add(Vec3::Zero());
  settings.box.add(spacing * Vec3(2.5 * column[0], 4 * column[1], 2 * column[2]));
  Fluid fluid(settings);
  for (int corner = 0, id = 0; corner < 2; ++corner)
    for (int z = 0; z < column[2]; ++z)
      for (int y = 0; y < column[1]; ++y)
        for (int x = 0; x < column[0]; ++x, ++id) {
          const Random random(3, static_cast<std::uint64_t>(id));
          const auto place = [&](int i, int axis) {
            return i + 0.5 + 0.1 * (random.uniform(static_cast<std::uint64_t>(axis)) - 0.5);
          };
          const Vec3 within = spacing * Vec3(place(x, 0), place(y, 1), place(z, 2));
          Particle particle;
          particle.id = static_cast<std::uint32_t>(id);
          particle.x = corner == 0
                           ? within
                           : Vec3(settings.box.max.x() - within.x(), within.y(), settings.box.max.z() - within.z());
          fluid.add(particle);
        }
  constexpr int before = 9 * steps_a_frame;
  for (int step = 0, frame = 1; frame <= frames; ++step) {
    fluid.step();
    if (step >= before && (step - before) % steps_a_frame == 0) take(frame++, shape_of(fluid.before_last_step()));
  }
}

void make_splash(int frames, const TakeFrame& take) {
  make_dam_break({80, 25, 50}, frames, take);
}

}  // namespace sinew::samples
