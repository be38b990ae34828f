#include "apps/samples/soup.h"

#include <Eigen/Geometry>
#include <array>
#include <cstdio>
#include <functional>
#include <span>
#include <vector>

#include "apps/samples/turns.h"
#include "engine/geometry/shape.h"

namespace sinew::samples {

namespace {

class ObjText {
 public:
  explicit ObjText(const std::string& material_file) {
    text_ = "# a chair made by sinew-samples, metres\nmtllib " + material_file + "\n";
  }

  void begin_part(const std::string& name, const std::string& material) {
    text_ += "g " + name + "\nusemtl " + material + "\n";
  }

  /// Its number, from 1.
  int vertex(const Vec3& p) {
    add_line("v %.6f %.6f %.6f\n", p);
    return ++vertices_;
  }
  int texture(double u, double v) {
    add_line("vt %.4f %.4f\n", Vec3(u, v, 0));
    return ++textures_;
  }

  void face(std::span<const int> corners, std::span<const int> textures = {}) {
    text_ += "f";
    for (std::size_t k = 0; k < corners.size(); ++k) {
      text_ += " " + std::to_string(corners[k]);
      if (!textures.empty()) text_ += "/" + std::to_string(textures[k]);
    }
    text_ += "\n";
  }

  const std::string& text() const { return text_; }

 private:
  void add_line(const char* format, const Vec3& p) {
    std::array<char, 96> line;
    std::snprintf(line.data(), line.size(), format, p.x() + 0.0, p.y() + 0.0, p.z() + 0.0);
    text_ += line.data();
  }

  std::string text_;
  int vertices_ = 0, textures_ = 0;
};

enum class Joined { Yes, No };

/// Rings of points, one after the other, as quads between them and a polygon at each end; wound so that they look
/// outwards where a ring turns counter-clockwise seen from the end it leads to. Not joined: each polygon has vertices
/// of its own.
void add_tube(ObjText& obj, const std::vector<std::vector<Vec3>>& rings, Joined joined) {
  std::vector<std::vector<int>> numbers(rings.size());
  if (joined == Joined::Yes)
    for (std::size_t r = 0; r < rings.size(); ++r)
      for (const Vec3& p : rings[r]) numbers[r].push_back(obj.vertex(p));
  const auto corner = [&](std::size_t r, std::size_t k) {
    k %= rings[r].size();
    return joined == Joined::Yes ? numbers[r][k] : obj.vertex(rings[r][k]);
  };
  const std::size_t around = rings[0].size();
  for (std::size_t r = 0; r + 1 < rings.size(); ++r)
    for (std::size_t k = 0; k < around; ++k)
      obj.face(std::array{corner(r, k), corner(r, k + 1), corner(r + 1, k + 1), corner(r + 1, k)});
  std::vector<int> bottom, top;
  for (std::size_t k = around; k-- > 0;) bottom.push_back(corner(0, k));
  for (std::size_t k = 0; k < around; ++k) top.push_back(corner(rings.size() - 1, k));
  obj.face(bottom);
  obj.face(top);
}

/// A round rod from a to b, `radius` a function of how far along, 0 to 1.
void add_rod(ObjText& obj, const Vec3& a, const Vec3& b, int sides, int lengths,
             const std::function<double(double)>& radius, Joined joined) {
  const Vec3 along = (b - a).normalized();
  const Vec3 u = along.cross(Vec3(0.36, 0.48, 0.8)).normalized(), v = along.cross(u);
  std::vector<std::vector<Vec3>> rings;
  for (int i = 0; i <= lengths; ++i) {
    const double t = double(i) / lengths;
    std::vector<Vec3>& ring = rings.emplace_back();
    for (int k = 0; k < sides; ++k) {
      const CosSin turn = cos_sin(double(k) / sides);
      ring.push_back(a + t * (b - a) + radius(t) * (turn.cos * u + turn.sin * v));
    }
  }
  add_tube(obj, rings, joined);
}

/// A seat of 24 corners: rings from the middle of the underside over the rim to the hollow of the upper side.
void add_seat(ObjText& obj) {
  obj.begin_part("seat", "seat");
  constexpr std::array<std::array<double, 2>, 8> profile{{{0.15, 0.425},
                                                          {0.195, 0.428},
                                                          {0.222, 0.440},
                                                          {0.226, 0.455},
                                                          {0.215, 0.466},
                                                          {0.19, 0.466},
                                                          {0.14, 0.457},
                                                          {0.08, 0.453}}};
  std::vector<std::vector<Vec3>> rings;
  for (const auto& [radius, height] : profile) {
    std::vector<Vec3>& ring = rings.emplace_back();
    for (int k = 0; k < 24; ++k) {
      const CosSin turn = cos_sin(-k / 24.0);
      ring.emplace_back(radius * turn.cos, height, 1.05 * radius * turn.sin);
    }
  }
  add_tube(obj, rings, Joined::Yes);
}

/// Legs as a lathe turns them, and an H of rods between them.
void add_legs(ObjText& obj) {
  const auto turned = [](double t) {
    const double bulge = t < 0.6 ? t / 0.6 : (1 - t) / 0.4;
    const bool bead = (t > 0.28 && t < 0.34) || (t > 0.84 && t < 0.9);
    return 0.012 + 0.011 * bulge * (2 - bulge) + (bead ? 0.005 : 0);
  };
  const auto foot = [](int x, int z) { return Vec3(0.21 * x, 0.004, 0.205 * z); };
  const auto head = [](int x, int z) { return Vec3(0.13 * x, 0.435, 0.135 * z); };
  for (const int x : {1, -1})
    for (const int z : {1, -1}) {
      obj.begin_part(std::string("leg_") + (x > 0 ? "front_" : "back_") + (z > 0 ? "right" : "left"), "wood");
      add_rod(obj, foot(x, z), head(x, z), 12, 30, turned, Joined::Yes);
    }
  const auto swelling = [](double t) { return 0.008 + 0.016 * t * (1 - t); };
  const auto within = [&](int x, int z) -> Vec3 { return 0.62 * foot(x, z) + 0.38 * head(x, z); };
  obj.begin_part("stretchers", "wood");
  for (const int z : {1, -1}) add_rod(obj, within(-1, z), within(1, z), 8, 12, swelling, Joined::No);
  add_rod(obj, 0.5 * (within(-1, -1) + within(1, -1)), 0.5 * (within(-1, 1) + within(1, 1)), 8, 12, swelling,
          Joined::No);
}

/// Points of the back's arc, u from -1 (left) to 1 (right): where it stands on the seat, and where it ends.
Vec3 back_foot(double u) {
  const CosSin turn = cos_sin(0.5 + 0.14 * u);
  return {0.185 * turn.cos, 0.455, -0.195 * turn.sin};
}
Vec3 back_head(double u) {
  const CosSin turn = cos_sin(0.5 + 0.12 * u);
  return {0.30 * turn.cos - 0.03, 1.0, -0.30 * turn.sin};
}

void add_back(ObjText& obj) {
  const auto swelling = [](double t) { return 0.006 + 0.012 * t * (1 - t); };
  obj.begin_part("spindles", "wood");
  for (const double u : {-1.0, -0.72, -0.44, 0.44, 0.72, 1.0})
    add_rod(obj, back_foot(u), back_head(u), 8, 24, swelling, Joined::No);

  // The crest: a bar along the arc, higher in its middle.
  obj.begin_part("crest", "seat");
  std::vector<std::vector<Vec3>> rings;
  for (int i = 0; i <= 28; ++i) {
    const double u = 1.15 * (2.0 * i / 28 - 1);
    const Vec3 p = back_head(u), out = 0.013 * Vec3(p.x() + 0.03, 0, p.z()).normalized();
    const Vec3 low(0, -0.03, 0), high(0, 0.035 + 0.035 * (1 - u * u / 1.4), 0);
    rings.push_back({p + low - out, p + high - out, p + high + out, p + low + out});
  }
  add_tube(obj, rings, Joined::No);
}

/// The board in the middle of the back, a single sheet with a rib behind it: the edges between are edges of three
/// faces.
void add_splat(ObjText& obj) {
  obj.begin_part("splat", "inlay");
  constexpr int rows = 20;
  std::array<int, 4> last{}, last_texture{};
  for (int i = 0; i <= rows; ++i) {
    const double t = double(i) / rows;
    const double width = 0.034 + 0.035 * t * (1 - t) * (1 + 2 * t);
    const Vec3 p = back_foot(0) + t * (back_head(0) - back_foot(0));
    const std::array now{obj.vertex(p - width * Vec3::UnitZ()), obj.vertex(p), obj.vertex(p + width * Vec3::UnitZ()),
                         obj.vertex(p - 0.03 * Vec3::UnitX())};
    const std::array texture{obj.texture(0, t), obj.texture(0.5, t), obj.texture(1, t), obj.texture(0.75, t)};
    const auto quad = [&](std::size_t a, std::size_t b) {
      obj.face(std::array{last[a], last[b], now[b], now[a]},
               std::array{last_texture[a], last_texture[b], texture[b], texture[a]});
    };
    if (i > 0) {
      quad(1, 0);
      quad(2, 1);
      quad(1, 3);
    }
    last = now;
    last_texture = texture;
  }
}

}  // namespace

std::string chair(const std::string& material_file) {
  ObjText obj(material_file);
  add_seat(obj);
  add_legs(obj);
  add_back(obj);
  add_splat(obj);
  return obj.text();
}

std::string chair_materials() {
  return "newmtl wood\nKd 0.55 0.36 0.20\n\nnewmtl seat\nKd 0.34 0.20 0.11\n\nnewmtl inlay\nKd 0.80 0.66 0.42\n";
}

}  // namespace sinew::samples
