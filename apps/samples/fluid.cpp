#include "apps/samples/fluid.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/check.h"
#include "engine/geometry/parallel.h"

namespace sinew::samples {

namespace {

constexpr std::size_t block_size = 2048;
constexpr double gravity = 9.81;

}  // namespace

Fluid::Fluid(const Settings& settings) : settings_(settings), h_(2 * settings.spacing) {
  CHECK(!settings.box.empty() && settings.spacing > 0, settings.spacing);
  for (std::size_t c = 0; c < 3; ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    cells_[c] = static_cast<std::size_t>((settings.box.max[axis] - settings.box.min[axis]) / h_) + 1;
  }
  // rho0, and the sum of eq. 11 for a particle within a cubic lattice, a fifth of which steadies those at the surface.
  Vec3 own = Vec3::Zero();
  double others = 0;
  for (int i = 0; i < 125; ++i) {
    const Vec3 r = settings.spacing * Vec3(i % 5 - 2, i / 5 % 5 - 2, i / 25 - 2);
    const double length = r.norm();
    if (length >= h_) continue;
    rho0_ += weight(length);
    if (length == 0) continue;
    const double q = 1 - length / h_;
    const Vec3 gradient = -3 * q * q / (h_ * length) * r;
    own += gradient;
    others += gradient.squaredNorm();
  }
  eps_ = 0.2 * (own.squaredNorm() + others) / (rho0_ * rho0_);
}

double Fluid::weight(double r) const {
  const double q = 1 - r / h_;
  return q * q * q;
}

Fluid::Beyond Fluid::beyond_walls(const Vec3& p) const {
  Beyond beyond;
  for (const double side : {1.0, -1.0}) {
    const Vec3 distance = side > 0 ? Vec3(p - settings_.box.min) : Vec3(settings_.box.max - p);
    for (int c = 0; c < 3; ++c) {
      if (distance[c] >= h_) continue;
      const double t = 1 - distance[c] / h_, t4 = t * t * t * t;
      beyond.share += t4 * t * (1.5 - t);
      beyond.gradient[c] -= side * t4 * (7.5 - 6 * t) / h_;
    }
  }
  return beyond;
}

void Fluid::add(const Particle& particle) {
  states_.push_back({particle, particle.x, particle.v, particle.v});
}

void Fluid::remove_if(const std::function<bool(const Particle&)>& gone) {
  std::erase_if(states_, [&](const State& state) { return gone(state.now); });
}

std::vector<Particle> Fluid::before_last_step() const {
  std::vector<Particle> particles;
  particles.reserve(size());
  for (const State& state : states_)
    particles.push_back({state.x_before, 0.5 * (state.u_before + state.u), state.now.id, state.now.age - settings_.dt});
  std::sort(particles.begin(), particles.end(), [](const Particle& a, const Particle& b) { return a.id < b.id; });
  return particles;
}

void Fluid::step() {
  predict();
  sort_into_cells();
  find_neighbours();
  correct();
  move();
}

template <class Body>
void Fluid::each(const Body& body) const {
  parallel_for(blocks_.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      const Block& block = blocks_[b];
      std::size_t begin = 0;
      for (std::size_t k = 0; k < block.ends.size(); ++k) {
        body(b * block_size + k, std::span(block.neighbours).subspan(begin, block.ends[k] - begin));
        begin = block.ends[k];
      }
    }
  });
}

void Fluid::keep_in_box(Vec3& p) const {
  p = p.cwiseMax(settings_.box.min).cwiseMin(settings_.box.max);
}

void Fluid::predict() {
  for (State& state : states_) state.now.v.y() -= settings_.dt * gravity;
}

std::array<std::size_t, 3> Fluid::cell_of(const Vec3& p) const {
  std::array<std::size_t, 3> cell{};
  for (std::size_t c = 0; c < 3; ++c) {
    const auto axis = static_cast<Eigen::Index>(c);
    const double at = (p[axis] - settings_.box.min[axis]) / h_;
    cell[c] = std::min(static_cast<std::size_t>(std::max(at, 0.0)), cells_[c] - 1);
  }
  return cell;
}

std::size_t Fluid::number_of(const std::array<std::size_t, 3>& cell) const {
  return (cell[2] * cells_[1] + cell[1]) * cells_[0] + cell[0];
}

/// The states in the order of their cells, within a cell as they were: what is near in space is near in memory.
void Fluid::sort_into_cells() {
  const std::size_t n = size();
  std::vector<Vec3> p(n);
  std::vector<std::size_t> cell(n);
  cell_begin_.assign(cells_[0] * cells_[1] * cells_[2] + 1, 0);
  for (std::size_t i = 0; i < n; ++i) {
    p[i] = states_[i].now.x + settings_.dt * states_[i].now.v;
    keep_in_box(p[i]);
    cell[i] = number_of(cell_of(p[i]));
    ++cell_begin_[cell[i] + 1];
  }
  for (std::size_t c = 1; c < cell_begin_.size(); ++c) cell_begin_[c] += cell_begin_[c - 1];
  std::vector<std::size_t> next = cell_begin_;
  std::vector<State> sorted(n);
  p_.resize(n);
  for (std::size_t i = 0; i < n; ++i) {
    const std::size_t to = next[cell[i]]++;
    sorted[to] = states_[i];
    p_[to] = p[i];
  }
  states_ = std::move(sorted);
}

void Fluid::find_neighbours() {
  const std::size_t n = size();
  blocks_.resize((n + block_size - 1) / block_size);
  parallel_for(blocks_.size(), 1, [&](std::size_t first, std::size_t last) {
    for (std::size_t b = first; b < last; ++b) {
      Block& block = blocks_[b];
      block.neighbours.clear();
      block.ends.clear();
      for (std::size_t i = b * block_size; i < std::min(n, (b + 1) * block_size); ++i) {
        const std::array<std::size_t, 3> cell = cell_of(p_[i]);
        const auto low = [&](std::size_t c) { return cell[c] - std::min<std::size_t>(cell[c], 1); };
        const auto high = [&](std::size_t c) { return std::min(cell[c] + 1, cells_[c] - 1); };
        for (std::size_t z = low(2); z <= high(2); ++z)
          for (std::size_t y = low(1); y <= high(1); ++y)
            for (std::size_t j = cell_begin_[number_of({low(0), y, z})];
                 j < cell_begin_[number_of({high(0), y, z}) + 1]; ++j)
              if (j != i && (p_[i] - p_[j]).squaredNorm() < h_ * h_) block.neighbours.push_back(static_cast<Index>(j));
        block.ends.push_back(block.neighbours.size());
      }
    }
  });
}

void Fluid::correct() {
  lambda_.resize(size());
  std::vector<Vec3> moved(size());
  // Particles in one place have no direction in which to part; the gradient there counts as zero.
  const auto gradient_factor = [&](double r) {
    const double q = 1 - r / h_;
    return r > 0 ? -3 * q * q / (h_ * r * rho0_) : 0.0;
  };
  for (int iteration = 0; iteration < settings_.iterations; ++iteration) {
    each([&](std::size_t i, std::span<const Index> neighbours) {
      const Beyond beyond = beyond_walls(p_[i]);
      double rho = 1 + rho0_ * beyond.share, others = 0;
      Vec3 own = beyond.gradient;
      for (const Index j : neighbours) {
        const Vec3 r = p_[i] - p_[j];
        const double length = r.norm();
        if (length >= h_) continue;
        rho += weight(length);
        const Vec3 gradient = gradient_factor(length) * r;
        own += gradient;
        others += gradient.squaredNorm();
      }
      const double C = std::max(rho / rho0_ - 1, 0.0);        // eq. 1
      lambda_[i] = -C / (own.squaredNorm() + others + eps_);  // eq. 11
    });
    each([&](std::size_t i, std::span<const Index> neighbours) {
      Vec3 p = p_[i];
      if (lambda_[i] < 0) p += lambda_[i] * beyond_walls(p_[i]).gradient;
      for (const Index j : neighbours) {
        const double sum = lambda_[i] + lambda_[j];
        if (sum == 0) continue;
        const Vec3 r = p_[i] - p_[j];
        const double length = r.norm();
        if (length < h_) p += sum * gradient_factor(length) * r;  // eq. 12
      }
      keep_in_box(p);
      moved[i] = p;
    });
    p_.swap(moved);
  }
}

void Fluid::move() {
  u_.resize(size());
  const double low = settings_.box.min.y() + settings_.spacing;
  for (std::size_t i = 0; i < size(); ++i) {
    State& state = states_[i];
    if (p_[i].y() <= low && settings_.grip > 0)
      for (const int c : {0, 2}) p_[i][c] -= settings_.grip * (p_[i][c] - state.now.x[c]);
    u_[i] = (p_[i] - state.now.x) / settings_.dt;
    state.x_before = state.now.x;
    state.u_before = state.u;
    state.u = u_[i];
    state.now.x = p_[i];
    state.now.age += settings_.dt;
  }
  each([&](std::size_t i, std::span<const Index> neighbours) {
    Vec3 sum = Vec3::Zero();
    for (const Index j : neighbours) {
      const double length = (p_[i] - p_[j]).norm();
      if (length < h_) sum += weight(length) * (u_[j] - u_[i]);
    }
    states_[i].now.v = u_[i] + settings_.viscosity / rho0_ * sum;  // eq. 17
  });
}

}  // namespace sinew::samples
