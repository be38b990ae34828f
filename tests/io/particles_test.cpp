/// Real particles: the splash through every format, and the files of other programs.

#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <map>

#include "engine/io/bgeo.h"
#include "engine/io/ply.h"
#include "engine/io/vtk.h"
#include "engine/io/vtp.h"
#include "engine/io/xyz.h"
#include "tests/io/file_checks.h"
#include "tests/shared_data.h"
#include "tests/usda_points.h"

namespace sinew::io {
namespace {

/// The same points, and the values of each attribute of `a` in the one of that name of `b`.
void expect_same(const Shape& a, const Shape& b, const std::string& format) {
  ASSERT_EQ(a.size(), b.size()) << format;
  for (std::size_t i = 0; i < a.size(); ++i)
    ASSERT_EQ(a.positions[i] + a.origin, b.positions[i] + b.origin) << format << " point " << i;
  for (const Attribute& attribute : a.attributes) {
    const Attribute* other = b.find(attribute.name);
    ASSERT_TRUE(other) << format << ' ' << attribute.name;
    EXPECT_EQ(other->kind, attribute.kind) << format << ' ' << attribute.name;
    ASSERT_EQ(other->components, attribute.components) << format << ' ' << attribute.name;
    for (std::size_t i = 0; i < a.size(); ++i)
      for (int c = 0; c < attribute.components; ++c)
        ASSERT_EQ(other->number(i, c), attribute.number(i, c)) << format << ' ' << attribute.name << ' ' << i;
  }
}

/// A file as gzip unpacks it.
std::string unpacked(const std::filesystem::path& path) {
  std::string out;
  FILE* pipe = popen(("gzip -dc '" + path.string() + "'").c_str(), "r");
  if (pipe == nullptr) return out;
  char buffer[65536];
  for (std::size_t size = 0; (size = std::fread(buffer, 1, sizeof buffer, pipe)) > 0;) out.append(buffer, size);
  pclose(pipe);
  return out;
}

/// Velocities are what moves the points, a unit of length a second at about 30 frames a second.
TEST(Particles, TheSplashHasPersistentIdsAndVelocities) {
  SHARED_DATA(folder, "particles/usd_splash");
  std::map<int, Vec3> before, velocity;
  std::size_t last = 0, pairs = 0;
  double along = 0, velocities = 0, ways = 0;
  for (int frame = 101; frame <= 108; ++frame) {
    const auto shape = read_usda_points(folder / ("Particles_Splash." + std::to_string(frame) + ".usd"));
    expect_sound(*shape, std::to_string(frame));
    EXPECT_EQ(shape->size(), last + 833) << frame;
    last = shape->size();
    std::map<int, Vec3> now, now_velocity;
    const Attribute& v = *shape->find("velocity");
    for (std::size_t i = 0; i < shape->size(); ++i) {
      const int id = static_cast<int>(shape->find("id")->number(i, 0));
      EXPECT_TRUE(now.emplace(id, shape->positions[i] + shape->origin).second) << "id " << id << " twice";
      now_velocity.emplace(id, Vec3(v.number(i, 0), v.number(i, 1), v.number(i, 2)));
    }
    for (const auto& [id, x] : before) {
      ASSERT_TRUE(now.contains(id)) << "id " << id << " is gone in frame " << frame;
      if (frame < 106) continue;  // the emitter still stirs them
      const Vec3 way = now.at(id) - x;
      along += way.dot(velocity.at(id));
      velocities += velocity.at(id).squaredNorm();
      ways += way.squaredNorm();
      ++pairs;
    }
    before = std::move(now);
    velocity = std::move(now_velocity);
  }
  EXPECT_EQ(pairs, 4165u + 4998 + 5831);
  EXPECT_NEAR(along / velocities, 1.0 / 30, 1.0 / 300);       // seconds a frame, by least squares
  EXPECT_GT(along * along / (velocities * ways), 0.9 * 0.9);  // the squared cosine between ways and velocities
}

TEST(Particles, TheSplashIsTheSameThroughEveryFormat) {
  SHARED_DATA(folder, "particles/usd_splash");
  struct Pair {
    const char* name;
    ReadFunction read;
    WriteFunction write;
  };
  const Pair pairs[] = {{"ply", read_ply, write_ply}, {"bgeo", read_bgeo, write_bgeo}, {"vtk", read_vtk, write_vtk},
                        {"vtp", read_vtp, write_vtp}, {"vtu", read_vtp, write_vtu},    {"csv", read_csv, write_csv},
                        {"xyz", read_xyz, write_xyz}};
  for (const int frame : {101, 108}) {
    const auto shape = read_usda_points(folder / ("Particles_Splash." + std::to_string(frame) + ".usd"));
    for (const Pair& pair : pairs) {
      EXPECT_TRUE(lost(pair.write, *shape).empty()) << pair.name;
      const std::string text = write_text(pair.write, *shape);
      const Shape again = read_text(pair.read, text);
      expect_sound(again, pair.name);
      expect_same(*shape, again, pair.name);
      EXPECT_TRUE(write_text(pair.write, again) == text) << pair.name;
      Shape moved = again;
      moved.positions[7] += Vec3(0.25, 0, -1);
      moved.find("velocity")->set_number(9, 1, 0.5);
      const Shape other = read_text(pair.read, write_text(pair.write, moved));
      EXPECT_EQ(other.find("velocity")->number(9, 1), 0.5) << pair.name;
      for (std::size_t i = 0; i < other.size(); ++i)
        ASSERT_NEAR((other.positions[i] + other.origin - moved.positions[i] - moved.origin).norm(), 0, 1e-5) << i;
    }
  }
}

TEST(Particles, BgeoOfOtherProgramsComesBackExactly) {
  SHARED_DATA(folder, "particles/partio");
  int files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() != ".bgeo") continue;
    expect_exact(read_bgeo, write_bgeo, entry.path().string());
    ++files;
  }
  EXPECT_EQ(files, 9);
  const Shape base = read_text(read_bgeo, text_of_file((folder / "base.bgeo").string()));
  ASSERT_TRUE(base.find("id") && base.find("life"));
  EXPECT_EQ(base.find("id")->kind, Kind::Id);
  EXPECT_EQ(base.find("id")->number(4, 0), 4);
  EXPECT_EQ(base.find("life")->components, 2);
  EXPECT_FLOAT_EQ(static_cast<float>(base.find("life")->number(0, 0)), -1.2F);
  const Shape scatter = read_text(read_bgeo, text_of_file((folder / "scatter.bgeo").string()));
  ASSERT_TRUE(scatter.find("color"));
  EXPECT_EQ(scatter.find("color")->kind, Kind::Color);
  EXPECT_EQ(scatter.notes, std::vector<std::string>{"Kept in the bgeo file only: 3 texts of the attribute \"test\"."});
}

TEST(Particles, TheDoubleDamBreakComesBackExactly) {
  SHARED_DATA(packed, "particles/splashsurf/dam_break_frame_9_6859_particles.bgeo");
  const std::string sentence = refusal(read_bgeo, text_of_file(packed.string()));
  EXPECT_NE(sentence.find("gzip-compressed data"), std::string::npos) << sentence;
  const std::string text = unpacked(packed);
  const Shape shape = read_text(read_bgeo, text);
  expect_sound(shape, packed.string());
  EXPECT_EQ(shape.size(), 6859u);
  ASSERT_TRUE(shape.find("velocity") && shape.find("id") && shape.find("density"));
  EXPECT_EQ(shape.find("velocity")->kind, Kind::Velocity);
  EXPECT_TRUE(write_text(write_bgeo, shape) == text);
  Shape copy = shape;
  copy.content = nullptr;
  expect_same(shape, read_text(read_bgeo, write_text(write_bgeo, copy)), "bgeo");
  expect_same(shape, read_text(read_vtp, write_text(write_vtp, copy)), "vtp");
}

TEST(Particles, JsonGeometryIsRefused) {
  SHARED_DATA(folder, "particles/houdini_geo");
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string sentence = refusal(read_bgeo, text_of_file(entry.path().string()));
    EXPECT_EQ(
        sentence,
        "test: byte 0: expected classic bgeo data that begins with \"BgeoV\", found the JSON geometry of Houdini 12 "
        "and later (save it as classic bgeo)");
  }
}

TEST(Particles, VtkOfOtherProgramsComesBackExactly) {
  SHARED_DATA(folder, "particles/splashsurf");
  for (const char* name :
       {"bunny_frame_14_7705_particles.vtk", "cube_2366_particles.vtk", "free_particles_125_particles.vtk"})
    expect_exact(read_vtk, write_vtk, (folder / name).string());
  const Shape bunny = read_text(read_vtk, text_of_file((folder / "bunny_frame_14_7705_particles.vtk").string()));
  ASSERT_TRUE(bunny.find("velocity") && bunny.find("id"));
  EXPECT_EQ(bunny.find("velocity")->kind, Kind::Velocity);
  EXPECT_EQ(bunny.find("id")->type, Type::UInt32);
  EXPECT_TRUE(bunny.notes.empty());
}

TEST(Particles, XmlOfOtherProgramsComesBackExactly) {
  SHARED_DATA(folder, "particles/splashsurf");
  const std::string path = (folder / "fluid_encoded_250_particles.vtu").string();
  expect_exact(read_vtp, write_vtu, path);
  const Shape fluid = read_text(read_vtp, text_of_file(path));
  EXPECT_EQ(fluid.size(), 250u);
  ASSERT_TRUE(fluid.find("velocity") && fluid.find("index") && fluid.find("pressure"));
  EXPECT_EQ(fluid.find("velocity")->kind, Kind::Velocity);
  EXPECT_EQ(fluid.find("index")->number(249, 0), 250);
  EXPECT_EQ(refusal(read_vtp, text_of_file((folder / "fluid_250_particles.vtu").string())),
            "test:6:9: expected data that are not compressed (writers can switch it off), found "
            "\"vtkZLibDataCompressor\"");
}

TEST(Particles, MeshesOfVtkComeBackExactly) {
  SHARED_DATA(liver, "tets/liver.vtk");
  expect_exact(read_vtk, write_vtk, liver.string());
  EXPECT_EQ(read_text(read_vtk, text_of_file(liver.string())).faces.size(), 10000u);
  SHARED_DATA(raptor, "tets/raptorTetra_8418.vtu");
  expect_exact(read_vtp, write_vtu, raptor.string());
  Shape tets = read_text(read_vtp, text_of_file(raptor.string()));
  EXPECT_EQ(tets.size(), 2996u);
  EXPECT_EQ(tets.tets.size(), 8418u);
  tets.content = nullptr;
  EXPECT_EQ(read_text(read_vtk, write_text(write_vtk, tets)).tets, tets.tets);
  EXPECT_EQ(read_text(read_vtp, write_text(write_vtu, tets)).tets, tets.tets);
  SHARED_DATA(broken, "malformed/sofa/Armadillo_Tetra_4406_for_test_broken.vtu");
  expect_refused_or_exact(read_vtp, write_vtu, broken.string());
}

}  // namespace
}  // namespace sinew::io
