#include "engine/io/gltf.h"

#include <fmt/format.h>

#include <array>

#include "engine/io/byte_source.h"
#include "tests/io/file_checks.h"
#include "tests/io/temporary_folder.h"
#include "tests/shared_data.h"

namespace sinew::io {

namespace {

std::string base64(const std::string& bytes) {
  static constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) out += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return out;
}

/// A file whose pieces tests replace: accessors 0 positions (4), 1 and 2 offsets, 3 indices (6), 4 times (3), 5 weights
/// (3 keys of 2), 6 the same as a cubic spline.
struct Maker {
  std::string bytes, views, accessors;
  std::string scene = R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";
  std::string primitive = R"("attributes":{"POSITION":0},"indices":3,"targets":[{"POSITION":1},{"POSITION":2}])";
  std::string mesh_members;
  std::string sampler = R"("input":4,"output":5)";
  std::string more;

  template <class T>
  void add(const std::vector<T>& values, int component_type, const char* type, std::size_t components,
           const std::string& members = "") {
    views += fmt::format(R"({}{{"buffer":0,"byteOffset":{},"byteLength":{}}})", views.empty() ? "" : ",", bytes.size(),
                         values.size() * sizeof(T));
    accessors += fmt::format(R"({}{{"bufferView":{},"componentType":{},"count":{},"type":"{}"{}}})",
                             accessors.empty() ? "" : ",", std::count(views.begin(), views.end(), '{') - 1,
                             component_type, values.size() / components, type, members);
    bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
    bytes.resize((bytes.size() + 3) / 4 * 4);
  }

  Maker() {
    add<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, 5126, "VEC3", 3);
    add<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, 5126, "VEC3", 3);
    add<float>({2, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0}, 5126, "VEC3", 3);
    add<std::uint16_t>({0, 1, 2, 0, 2, 3}, 5123, "SCALAR", 1);
    add<float>({0, 0.25F, 0.5F}, 5126, "SCALAR", 1);
    add<float>({0, 0, 1, 0, 0.5F, 1}, 5126, "SCALAR", 1);
    add<float>({9, 9, 0, 0, 9, 9, 9, 9, 1, 0, 9, 9, 9, 9, 0.5F, 1, 9, 9}, 5126, "SCALAR", 1);
  }

  std::string buffer() const { return R"("uri":"data:application/octet-stream;base64,)" + base64(bytes) + "\""; }
  std::string text(const std::string& buffer) const {
    const std::string animation = sampler.empty()
                                      ? ""
                                      : R"(,"animations":[{"samplers":[{)" + sampler +
                                            R"(}],"channels":[{"sampler":0,"target":{"node":0,"path":"weights"}}]}])";
    return R"({"asset":{"version":"2.0"},)" + scene + R"(,"meshes":[{"primitives":[{)" + primitive + "}]" +
           mesh_members + R"(},{"primitives":[]}],"bufferViews":[)" + views + R"(],"accessors":[)" + accessors +
           R"(],"buffers":[{"byteLength":)" + std::to_string(bytes.size()) + (buffer.empty() ? "" : ",") + buffer +
           "}]" + animation + more + "}";
  }
  std::string text() const { return text(buffer()); }

  std::string glb() const {
    std::string json = text("");
    json.resize((json.size() + 3) / 4 * 4, ' ');
    std::string out = "glTF";
    const auto put = [&out](std::size_t x) {
      for (int i = 0; i < 4; ++i) out += static_cast<char>(x >> (8 * i) & 255);
    };
    put(2);
    put(28 + json.size() + bytes.size());
    put(json.size());
    out += "JSON" + json;
    put(bytes.size());
    return out + std::string("BIN\0", 4) + bytes;
  }
};

Sequence open_text(const std::string& text, const std::string& path = "test") {
  return open_gltf(bytes_in_memory(path, bytes_of(text)), {});
}

std::vector<Vec3> world(const Shape& shape) {
  std::vector<Vec3> out = shape.positions;
  for (Vec3& p : out) p += shape.origin;
  return out;
}

std::string refused(const Maker& maker) {
  return sentence_of([&] {
    const Sequence sequence = open_text(maker.text(), "a.gltf");
    for (const int frame : sequence.frames) sequence.load(frame);
  });
}

void replace(std::string& text, const std::string& what, const std::string& with) {
  ASSERT_NE(text.find(what), std::string::npos) << what;
  text.replace(text.find(what), what.size(), with);
}

const std::vector<Vec3> last_key{{2, 0, 0.5}, {1, 0, 0.5}, {1, 1, 0.5}, {0, 1, 0.5}};

Shape quad(double bend) {
  Shape shape;
  shape.positions = {{0, 0, 0}, {1, 0, bend}, {1, 1, -bend}, {0, 1 + bend, 0}, {5, 5, 5}};
  shape.faces.add(std::array<Index, 4>{0, 1, 2, 3});
  return shape;
}

}  // namespace

TEST(Gltf, FramesAreTheKeysOfTheWeights) {
  const std::string cubic = R"("input":4,"output":6,"interpolation":"CUBICSPLINE")";
  for (const std::string sampler :
       {R"("input":4,"output":5)", R"("input":4,"output":5,"interpolation":"STEP")", cubic.c_str()}) {
    Maker maker;
    maker.sampler = sampler;
    for (const std::string& text : {maker.text(), maker.glb()}) {
      const Sequence sequence = open_text(text);
      EXPECT_EQ(sequence.frames, (std::vector<int>{0, 1, 2}));
      EXPECT_EQ(sequence.rate, 4);
      EXPECT_EQ(world(*sequence.load(0)), (std::vector<Vec3>{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}));
      EXPECT_EQ(world(*sequence.load(1)), (std::vector<Vec3>{{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}));
      EXPECT_EQ(world(*sequence.load(2)), last_key) << sampler;
      EXPECT_EQ(sequence.load(2)->faces.points, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
      EXPECT_TRUE(sequence.load(0)->notes.empty());
    }
  }
}

TEST(Gltf, WithoutAnAnimationThereIsOneFrameWithTheWeightsOfTheMesh) {
  Maker maker;
  maker.sampler = "";
  maker.mesh_members = R"(,"weights":[0.5,1])";
  const Sequence sequence = open_text(maker.text());
  EXPECT_EQ(sequence.frames, std::vector<int>{1});
  EXPECT_EQ(world(*sequence.load(1)), last_key);
  EXPECT_EQ(sequence.load(1)->notes,
            std::vector<std::string>{"Kept in the glTF file only: 2 morph targets without an animation."});
  replace(maker.scene, R"({"mesh":0})", R"({"mesh":0,"weights":[0,0]})");
  EXPECT_EQ(world(*open_text(maker.text()).load(1))[0], Vec3(0, 0, 0)) << "the node's come first";
}

TEST(Gltf, BuffersMayLieBesideTheFile) {
  const TemporaryFolder folder;
  const Maker maker;
  std::ofstream(folder / "a b.bin", std::ios::binary) << maker.bytes;
  std::ofstream(folder / "a.gltf", std::ios::binary) << maker.text(R"("uri":"a%20b.bin")");
  EXPECT_EQ(world(*open_sequence(folder / "a.gltf").load(2)), last_key);
  std::filesystem::remove(folder / "a b.bin");
  EXPECT_EQ(sentence_of([&] { open_sequence(folder / "a.gltf"); }),
            (folder / "a.gltf") + ": buffers[0].uri: expected a file beside it, found no \"a b.bin\"");
}

TEST(Gltf, NodesMoveTheMesh) {
  Maker maker;
  maker.scene = R"("scenes":[{"nodes":[2]}],"nodes":[{"mesh":0,"translation":[1,2,3]},{"mesh":1},
    {"children":[0,1],"rotation":[0,0,0.7071067811865476,0.7071067811865476],"scale":[2,2,2]}])";
  const auto shape = open_text(maker.text()).load(0);
  EXPECT_EQ(shape->position_type, Type::Float64);
  EXPECT_LT((world(*shape)[1] - Vec3(-4, 4, 6)).norm(), 1e-12);
  EXPECT_EQ(shape->notes, std::vector<std::string>{"Not read from the glTF file: 1 other node with a mesh."});
  maker.scene = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0,"matrix":[0,1,0,0,-1,0,0,0,0,0,1,0,7,8,9,1]}])";
  EXPECT_EQ(world(*open_text(maker.text()).load(0))[2], Vec3(6, 9, 9));
  maker.scene = R"("scenes":[{"nodes":[0]}],"nodes":[{"children":[1]},{"children":[0]}])";
  EXPECT_EQ(refused(maker), "a.gltf: nodes[1].children[0]: expected a tree of nodes, found node 0 twice");
}

TEST(Gltf, AccessorsMayBeSparseInterleavedAndNormalized) {
  Maker maker;
  // Accessor 7: all zero but for elements 1 and 3.
  maker.add<std::uint8_t>({1, 3}, 5121, "SCALAR", 1);
  maker.add<float>({1, 2, 3, 4, 5, 6}, 5126, "VEC3", 3);
  maker.accessors += R"(,{"componentType":5126,"count":4,"type":"VEC3","sparse":{"count":2,
    "indices":{"bufferView":7,"componentType":5121},"values":{"bufferView":8}}})";
  replace(maker.primitive, R"({"POSITION":1})", R"({"POSITION":9})");
  EXPECT_EQ(world(*open_text(maker.text()).load(1)), (std::vector<Vec3>{{0, 0, 0}, {2, 2, 3}, {1, 1, 0}, {4, 6, 6}}));

  // Positions as normalized bytes, four bytes apart.
  Maker bytes;
  bytes.add<std::int8_t>({127, -127, 0, 99, -128, 0, 127, 99, 0, 127, 0, 99, 0, 0, 0, 99}, 5120, "SCALAR", 1);
  bytes.views.pop_back();
  bytes.views += R"(,"byteStride":4})";
  bytes.accessors += R"(,{"bufferView":7,"componentType":5120,"normalized":true,"count":4,"type":"VEC3"})";
  replace(bytes.primitive, R"({"POSITION":0})", R"({"POSITION":8})");
  EXPECT_EQ(world(*open_text(bytes.text()).load(0)), (std::vector<Vec3>{{1, -1, 0}, {-1, 0, 1}, {0, 1, 0}, {0, 0, 0}}));
}

TEST(Gltf, StripsFansAndSeveralPrimitives) {
  Maker maker;
  maker.sampler = "";
  maker.primitive = R"("attributes":{"POSITION":0},"mode":5},{"attributes":{"POSITION":0},"mode":6},
    {"attributes":{"POSITION":1,"NORMAL":1},"indices":3},{"attributes":{"POSITION":0},"mode":1)";
  const auto shape = open_text(maker.text()).load(1);
  EXPECT_EQ(shape->size(), 8u) << "vertices that primitives share are there once";
  EXPECT_EQ(shape->faces.points, (std::vector<Index>{0, 1, 2, 2, 1, 3, 0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7}));
  EXPECT_EQ(
      shape->notes,
      (std::vector<std::string>{
          "Not read from the glTF file: the lines or single points of 1 primitive.",
          "Not read from the glTF file: normals, colours, texture coordinates and other attributes of vertices."}));
}

TEST(Gltf, WrongFilesAreRefusedWithTheirPlace) {
  const auto with = [](std::string Maker::*piece, const std::string& what, const std::string& by) {
    Maker maker;
    replace(maker.*piece, what, by);
    return refused(maker);
  };
  EXPECT_EQ(with(&Maker::primitive, R"("indices":3)", R"("indices":30)"),
            "a.gltf: meshes[0].primitives[0].indices: expected a whole number of 0 to 6, found 30.0");
  EXPECT_EQ(
      with(&Maker::primitive, R"("indices":3)", R"("indices":5)"),
      "a.gltf: meshes[0].primitives[0].indices: expected indices of a component type 5121, 5123 or 5125, found 5126");
  EXPECT_EQ(with(&Maker::primitive, R"({"POSITION":2})", R"({"POSITION":4})"),
            "a.gltf: meshes[0].primitives[0].targets[1].POSITION: expected offsets of 4 vertices, found 3");
  EXPECT_EQ(with(&Maker::sampler, R"("output":5)", R"("output":4)"),
            "a.gltf: animations[0].samplers[0]: expected 3 keys of 2 weights, found 3 weights");
  EXPECT_EQ(with(&Maker::accessors, R"("count":4)", R"("count":5)"),
            "a.gltf: accessors[0]: expected 5 elements of 12 bytes, found only 48 bytes of its bufferView");
  EXPECT_EQ(with(&Maker::accessors, R"("bufferView":0,)", R"("bufferView":0,"byteOffset":4000000000,)"),
            "a.gltf: accessors[0]: expected 4 elements of 12 bytes, found only 0 bytes of its bufferView");
  EXPECT_EQ(with(&Maker::accessors, R"("bufferView":0,"componentType":5126,"count":4)",
                 R"("componentType":5126,"count":4000000000)")
                .substr(0, 73),
            "a.gltf: accessors[0]: expected no more elements than the file has bytes, ");
  Maker high;
  high.bytes[high.bytes.size() - 72 - 24 - 12 - 12] = 9;
  EXPECT_EQ(refused(high), "a.gltf: meshes[0].primitives[0]: expected indices below 4, found 9");
  EXPECT_EQ(with(&Maker::views, R"("byteOffset":48)", R"("byteOffset":1e300)"),
            "a.gltf: bufferViews[1].byteOffset: expected a whole number of 0 to 9007199254740992, found 1e+300");
  EXPECT_EQ(with(&Maker::scene, R"("mesh":0)", R"("name":"none")"), "a.gltf: expected a mesh in the scene, found none");
  EXPECT_EQ(with(&Maker::scene, R"("scene":0)", R"("extensionsRequired":["KHR_draco_mesh_compression"],"scene":0)"),
            "a.gltf: extensionsRequired[0]: expected geometry that is not compressed, found "
            "\"KHR_draco_mesh_compression\"");
  const auto text = [](const std::string& bytes) { return refusal(read_gltf, bytes, "a.gltf"); };
  EXPECT_EQ(text(""), "a.gltf: byte 0: expected JSON, found the end of the text");
  EXPECT_EQ(text("{}"), "a.gltf: expected a member \"asset\", found none");
  EXPECT_EQ(text(R"({"asset":{"version":"1.0"}})"), "a.gltf: asset.version: expected 2.0, found \"1.0\"");
  EXPECT_EQ(text(std::string(100000, '[')), "a.gltf: byte 0: expected JSON, found more than 64 levels of nesting");
  const std::string glb = Maker().glb();
  EXPECT_EQ(text(glb.substr(0, glb.size() - 1)), "a.gltf: byte 8: expected " + std::to_string(glb.size()) +
                                                     " bytes, found only " + std::to_string(glb.size() - 1));
}

TEST(Gltf, WhatIsWrittenIsReadBack) {
  const TemporaryFolder folder;
  for (const char* kind : {"glb", "gltf"}) {
    const std::string path = folder / (std::string("a.") + kind);
    FrameWriterOptions options;
    options.frames = {3, 4, 6, 9};
    options.rate = 25;
    const auto writer = create_frames(path, options);
    for (const int frame : {6, 9, 3, 4}) writer->write(frame, quad(0.1F * static_cast<float>(frame)));
    EXPECT_EQ(writer->commit().lost,
              std::vector<std::string>{"glTF cannot hold 1 face of more than 3 corners: cut into triangles."});
    const Sequence again = open_sequence(path);
    EXPECT_EQ(again.frames, options.frames);
    EXPECT_EQ(again.rate, 25);
    for (const int frame : again.frames) {
      const auto shape = again.load(frame);
      const Shape expected = quad(0.1F * static_cast<float>(frame));
      ASSERT_EQ(shape->size(), expected.size());
      for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_LT((world(*shape)[i] - expected.positions[i]).norm(), 1e-7) << frame;
      EXPECT_EQ(shape->faces.points, (std::vector<Index>{0, 1, 2, 0, 2, 3}));
    }
  }
}

TEST(Gltf, FramesOnASmallGridAreExact) {
  // Positions whose offsets are floats come back bit for bit.
  const TemporaryFolder folder;
  FrameWriterOptions options;
  options.frames = {0, 1, 2, 3, 4, 5, 6, 7};
  const auto writer = create_frames(folder / "a.glb", options);
  for (const int frame : options.frames) writer->write(frame, quad(frame / 1024.0));
  writer->commit();
  const Sequence again = open_sequence(folder / "a.glb");
  for (const int frame : options.frames) EXPECT_EQ(world(*again.load(frame)), quad(frame / 1024.0).positions);
}

TEST(Gltf, AnUnchangedFileIsCopied) {
  const TemporaryFolder folder;
  Maker maker;
  maker.more = R"(,"extras":"kept")";
  std::ofstream(folder / "a.glb", std::ios::binary) << maker.glb();
  const auto copy = [&](const std::string& to, bool change) {
    const Sequence sequence = open_sequence(folder / "a.glb");
    FrameWriterOptions options;
    options.frames = sequence.frames;
    options.rate = sequence.rate;
    options.force = true;
    const auto writer = create_frames(to, options);
    for (const int frame : sequence.frames) {
      Shape shape = *sequence.load(frame);
      if (change && frame == 2) shape.positions[3].z() += 1;
      writer->write(frame, shape);
    }
    return writer->commit();
  };
  EXPECT_TRUE(copy(folder / "b.glb", false).lost.empty());
  EXPECT_TRUE(text_of_file(folder / "b.glb") == maker.glb());
  EXPECT_EQ(copy(folder / "b.glb", true).lost,
            std::vector<std::string>{"The other content of the glTF file that it came from (materials, attributes, "
                                     "nodes) is not written."});
  EXPECT_FALSE(text_of_file(folder / "b.glb") == maker.glb());
  EXPECT_EQ(world(*open_sequence(folder / "b.glb").load(2))[3], Vec3(0, 1, 1.5));
  copy(folder / "b.gltf", false);
  EXPECT_EQ(world(*open_sequence(folder / "b.gltf").load(2)), last_key);
}

TEST(Gltf, WhatCannotBeWrittenIsRefused) {
  const TemporaryFolder folder;
  const std::string path = folder / "a.glb";
  FrameWriterOptions options;
  options.frames = {1, 2, 3};
  options.share = Share{1, 2};
  EXPECT_EQ(sentence_of([&] { create_frames(path, options); }),
            path + ": expected one process, for a glTF file is written at once, found a share of its frames");
  options.share.reset();
  options.frames = {-1, 0};
  EXPECT_EQ(sentence_of([&] { create_frames(path, options); }),
            path + ": expected frames of 0 and more, for glTF has no time below zero, found frame -1");
  options.frames = {1, 2, 3};
  const auto writer = create_frames(path, options);
  writer->write(1, quad(0));
  Shape other = quad(1);
  other.faces = {};
  EXPECT_EQ(sentence_of([&] { writer->write(2, other); }),
            path + ": expected the faces of other frames in frame 2, found others");
  other.positions.pop_back();
  EXPECT_EQ(sentence_of([&] { writer->write(2, other); }),
            path + ": expected as many points in frame 2 as in others, 5, found 4");
  EXPECT_EQ(sentence_of([&] { writer->commit(); }), path + ": expected all of its 3 frames, found no frame 2-3");
  EXPECT_FALSE(std::filesystem::exists(path));
}

TEST(Gltf, PointsWithoutFacesAndOddNumbers) {
  Shape shape;
  shape.positions = {{1, 2, 3}, {NAN, 0, 0}};
  EXPECT_EQ(lost(write_gltf, shape),
            std::vector<std::string>{"glTF cannot hold 1 point that is not finite: written as 0 0 0."});
  const Shape again = read_text(read_gltf, write_text(write_gltf, shape));
  EXPECT_EQ(world(again), (std::vector<Vec3>{{1, 2, 3}, {0, 0, 0}}));
  EXPECT_TRUE(again.faces.empty());
}

TEST(Gltf, RealAnimationsMoveAndAreCopied) {
  for (const auto& [name, points, frames] :
       {std::tuple("Flamingo.glb", 337u, 15u), std::tuple("Horse.glb", 796u, 16u)}) {
    SHARED_DATA(file, std::filesystem::path("anim/gltf_morph") / name);
    const Sequence sequence = open_sequence(file.string());
    ASSERT_EQ(sequence.frames.size(), frames);
    const auto first = sequence.load(sequence.frames[0]), fifth = sequence.load(sequence.frames[4]);
    expect_sound(*first, name);
    EXPECT_EQ(first->size(), points);
    EXPECT_NE(first->positions, fifth->positions);
    const TemporaryFolder folder;
    FrameWriterOptions options;
    options.frames = sequence.frames;
    options.rate = sequence.rate;
    const auto copy = create_frames(folder / "copy.glb", options), made = create_frames(folder / "made.gltf", options);
    for (const int frame : sequence.frames) {
      copy->write(frame, *sequence.load(frame));
      made->write(frame, *sequence.load(frame));
    }
    copy->commit();
    made->commit();
    EXPECT_TRUE(text_of_file(folder / "copy.glb") == text_of_file(file.string()));
    const Sequence again = open_sequence(folder / "made.gltf");
    for (const int frame : sequence.frames) {
      const auto expected = sequence.load(frame), found = again.load(frame);
      for (std::size_t i = 0; i < expected->size(); ++i)
        ASSERT_LT((world(*expected)[i] - world(*found)[i]).norm(), 1e-6 * 400) << name << frame;
    }
  }
}

}  // namespace sinew::io
