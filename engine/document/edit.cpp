#include "engine/document/edit.h"

#include <array>
#include <filesystem>

#include "engine/document/input_hash.h"
#include "engine/document/shared_arrays.h"
#include "engine/io/io.h"

namespace sinew::document {

/// The settings of a layer: an object whose names are free.
struct SettingsObject {
  std::vector<SettingEdit> rows;
  bool operator==(const SettingsObject&) const = default;
};

/// The value of "box", [min, max].
struct Corners {
  Vec3 min = Vec3::Zero(), max = Vec3::Zero();
};

/// The value of "sphere".
struct Ball {
  Vec3 center = Vec3::Zero();
  double radius = 0;
};

/// The whole file; paths as they stand in it.
struct EditFile {
  int version = 1;
  Project project;
};

template <class T, class U>
concept Is = std::is_same_v<std::remove_const_t<T>, U>;

template <class T>
requires Is<T, Selection> || Is<T, Ball> || Is<T, Rotation> || Is<T, Motion> || Is<T, HandleEdit> || Is<T, Stiffness> ||
    Is<T, Key> || Is<T, CutEdit> || Is<T, ParticlePath> || Is<T, MarkerMatch> || Is<T, MarkersEdit> || Is<T, Layer> ||
    Is<T, EditFile>
inline constexpr bool is_object<T> = true;

static void read_value(const JsonFile& file, const Json& json, SettingsObject& settings) {
  if (json.type != Json::Type::Object) throw file.error(json, "an object of settings");
  for (const JsonMember& member : json.members()) {
    if (member.value.type == Json::Type::Number)
      settings.rows.push_back({member.name, member.value.number, file.place(member.value)});
    else if (member.value.type == Json::Type::Text)
      settings.rows.push_back({member.name, member.value.text(), file.place(member.value)});
    else
      throw file.error(member.value, "a number or a text");
  }
}

static void write_value(JsonWriter& out, const SettingsObject& settings) {
  out.begin_object();
  for (const SettingEdit& row : settings.rows) {
    out.key(row.name);
    std::visit([&](const auto& value) { write_value(out, value); }, row.value);
  }
  out.end_object();
}

static void read_value(const JsonFile& file, const Json& json, Corners& box) {
  if (json.type != Json::Type::Array || json.items().size() != 2) throw file.error(json, "2 corners [min, max]");
  read_value(file, json.items()[0], box.min);
  read_value(file, json.items()[1], box.max);
  if (!(box.min.array() <= box.max.array()).all())
    throw file.error(json, "a box whose min is nowhere above its max", "one that is");
}

static void write_value(JsonWriter& out, const Corners& box) {
  out.begin_array(true);
  write_value(out, box.min);
  write_value(out, box.max);
  out.end_array();
}

/// In a journal a long array is a text, its number among the arrays that stand beside.
template <class T>
static void read_value(const JsonFile& file, const Json& json, Shared<T>& shared) {
  if (file.arrays() != nullptr && json.type == Json::Type::Text) {
    const Shared<T>* array = file.arrays()->find<T>(json.text());
    if (array == nullptr) throw file.error(json, "the number of an array before this");
    shared = *array;
    return;
  }
  std::vector<T> values;
  read_value(file, json, values);
  shared = Shared<T>(std::move(values));
}

template <class T>
static void write_value(JsonWriter& out, const Shared<T>& shared) {
  if (out.arrays() != nullptr && shared.get().size() > SharedArrays::longest_in_text)
    out.text(std::to_string(out.arrays()->number_of(shared)));
  else
    write_value(out, shared.get());
}

static void read_value(const JsonFile& file, const Json& json, std::optional<double>& value) {
  value.reset();
  if (json.type != Json::Type::Null) read_value(file, json, value.emplace());
}

static void write_value(JsonWriter& out, const std::optional<double>& value) {
  if (value)
    write_value(out, *value);
  else
    out.raw("null");
}

template <class A>
static void fields(A& a, Is<Ball> auto& ball) {
  a.required("center", ball.center);
  a.required("radius", ball.radius, not_negative);
}

template <class A>
static void fields(A& a, Is<SelectAll> auto& all) {
  a.required("all", all.all);
  if constexpr (A::reading)
    if (!all.all) throw a.file().error(*a.json().find("all"), "true");
}

template <class A>
static void fields(A& a, Is<SelectIndices> auto& indices) {
  a.required("indices", indices.points);
}

template <class A>
static void fields(A& a, Is<SelectBox> auto& box) {
  Corners corners{box.min, box.max};
  a.required("box", corners);
  if constexpr (A::reading) box = {corners.min, corners.max};
}

template <class A>
static void fields(A& a, Is<SelectSphere> auto& sphere) {
  Ball ball{sphere.center, sphere.radius};
  a.required("sphere", ball);
  if constexpr (A::reading) sphere = {ball.center, ball.radius};
}

template <class A>
static void fields(A& a, Is<SelectNearest> auto& nearest) {
  a.required("nearest", nearest.to);
}

template <class A>
static void fields(A& a, Is<SelectComponent> auto& component) {
  a.required("component", component.number);
}

template <class A>
static void fields(A& a, Is<SelectLabels> auto& labels) {
  a.required("labels", labels.path);
  a.required("value", labels.value);
}

template <class A>
static void fields(A& a, Is<SelectPlaces> auto& places) {
  a.required("places", places.at);
  if constexpr (A::reading)
    if (const Json* json = a.json().find("places"); json != nullptr && places.at.get().empty())
      throw a.file().error(*json, "at least one place", "none");
}

/// Sets `what` to the alternative whose first member the object has; the names stand in the order of the variant.
static void choose_kind(const ObjectReader& reader, Selection& selection) {
  static constexpr std::array names = {"all", "indices", "box", "sphere", "nearest", "component", "labels", "places"};
  static_assert(names.size() == std::variant_size_v<decltype(selection.what)>);
  std::string expected = "a selection, one of", found;
  std::size_t kind = names.size();
  for (std::size_t i = 0; i < names.size(); ++i) {
    expected += (i == 0 ? " \"" : ", \"") + std::string(names[i]) + "\"";
    if (reader.json().find(names[i]) == nullptr) continue;
    if (kind < names.size()) found = sinew::quoted(names[kind]) + " and " + sinew::quoted(names[i]);
    kind = i;
  }
  if (kind == names.size()) {
    const auto members = reader.json().members();
    found = members.empty() ? "an object without members" : sinew::quoted(members.front().name);
  }
  if (!found.empty()) throw reader.file().error(reader.json(), expected, found);
  const auto emplace = [&]<std::size_t... I>(std::index_sequence<I...>) {
    ((I == kind ? void(selection.what.emplace<I>()) : void()), ...);
  };
  emplace(std::make_index_sequence<names.size()>{});
}

template <class A>
static void fields(A& a, Is<Selection> auto& selection) {
  if constexpr (A::reading) choose_kind(a, selection);
  std::visit([&](auto& what) { fields(a, what); }, selection.what);
  a.optional("frame", selection.frame);
  a.place(selection.place);
}

template <class A>
static void fields(A& a, Is<Rotation> auto& rotation) {
  a.required("axis", rotation.axis);
  a.required("degrees", rotation.degrees);
  a.optional("about", rotation.about);
  if constexpr (A::reading)
    if (a.json().find("axis") != nullptr && !(rotation.axis.stableNorm() > 0))
      throw a.file().error(*a.json().find("axis"), "an axis of a length above 0", "[0, 0, 0]");
}

static void check_motion(const ObjectReader& reader, const Motion& motion) {
  const auto throw_at = [&](const char* member, const std::string& expected, const std::string& found) {
    throw reader.file().error(*reader.json().find(member), expected, found);
  };
  const bool moves = motion.move || motion.rotate || motion.matrix;
  const bool to = reader.json().find("to") != nullptr;
  if (!moves && !to)
    throw reader.file().error(reader.json(), "a motion: \"move\", \"rotate\", \"matrix\" or \"to\"", "none");
  if (to && motion.to.get().empty()) throw_at("to", "at least one target", "none");
  if (moves && to) throw_at("to", "\"to\" alone", "another motion beside it");
  if (motion.matrix && motion.matrix->row(3) != Eigen::RowVector4d(0, 0, 0, 1))
    throw_at("matrix", "a last row of [0, 0, 0, 1]", "another");
}

template <class A>
static void fields(A& a, Is<Motion> auto& motion) {
  a.optional("rotate", motion.rotate);
  a.optional("matrix", motion.matrix);
  a.optional("move", motion.move);
  a.optional("to", motion.to);
  if constexpr (A::reading) check_motion(a, motion);
}

template <class A>
static void fields(A& a, Is<HandleEdit> auto& handle) {
  a.optional("name", handle.name);
  a.required("points", handle.points);
  fields(a, handle.motion);
  a.place(handle.place);
}

template <class A>
static void fields(A& a, Is<Stiffness> auto& stiffness) {
  a.required("points", stiffness.points);
  a.required("factor", stiffness.factor, positive);
}

static constexpr std::array interpolations = {"linear", "smooth", "hold"};

static void read_value(const JsonFile& file, const Json& json, Interpolation& value) {
  std::string name;
  read_value(file, json, name);
  const auto found = std::find(interpolations.begin(), interpolations.end(), name);
  if (found == interpolations.end()) throw file.error(json, "\"linear\", \"smooth\" or \"hold\"");
  value = static_cast<Interpolation>(found - interpolations.begin());
}

static void write_value(JsonWriter& out, Interpolation value) {
  out.text(interpolations[static_cast<std::size_t>(value)]);
}

template <class A>
static void fields(A& a, Is<Key> auto& key) {
  a.required("frame", key.frame);
  a.required("handles", key.handles);
  a.optional("example_weights", key.example_weights);
  a.optional("interpolation", key.interpolation);
  a.place(key.place);
}

static void check_keys(const ObjectReader& reader, const Layer& layer) {
  const Json* json = reader.json().find("keys");
  for (std::size_t k = 0; k < layer.keys.size(); ++k) {
    const Key& key = layer.keys[k];
    const Json& at = json->items()[k];
    if (k > 0 && key.frame <= layer.keys[k - 1].frame)
      throw reader.file().error(at, "keys in ascending order of frames", "frame " + std::to_string(key.frame));
    if (key.handles.size() > layer.handles.size())
      throw reader.file().error(
          at, "at most " + std::to_string(layer.handles.size()) + " motions, one a handle of the layer",
          std::to_string(key.handles.size()));
  }
}

template <class A>
static void fields(A& a, Is<CutEdit> auto& cut) {
  a.required("path", cut.path);
  a.required("depth", cut.depth);
  a.place(cut.place);
  if constexpr (A::reading) {
    const Json* path = a.json().find("path");
    if (path != nullptr && cut.path.size() < 2) throw a.file().error(*path, "two points or more", "fewer");
    const Json* depth = a.json().find("depth");
    if (depth != nullptr && !(cut.depth.norm() > 0)) throw a.file().error(*depth, "a depth above 0", "[0, 0, 0]");
  }
}

template <class A>
static void fields(A& a, Is<ParticlePath> auto& path) {
  a.optional("id", path.id);
  std::optional<int> given = path.every == 1 ? std::nullopt : std::optional(path.every);
  a.optional("every", given);
  a.optional("points", path.points);
  a.place(path.place);
  if constexpr (A::reading) {
    const Json *every = a.json().find("every"), *points = a.json().find("points"), *id = a.json().find("id");
    path.every = given.value_or(1);
    if (every != nullptr && path.every < 1) throw a.file().error(*every, "a whole number of at least 1");
    if (points != nullptr && path.points.get().size() < 2) throw a.file().error(*points, "two points or more", "fewer");
    if (points != nullptr && (every != nullptr || id != nullptr))
      throw a.file().error(a.json(), "\"points\" alone, or \"id\" and \"every\"", "both");
  }
}

template <class A>
static void fields(A& a, Is<MarkerMatch> auto& match) {
  a.required("name", match.name);
  a.required("place", match.place);
  a.place(match.at);
}

template <class A>
static void fields(A& a, Is<MarkersEdit> auto& markers) {
  a.required("file", markers.path);
  a.optional("first", markers.first);
  a.optional("only", markers.only);
  a.optional("matches", markers.matches);
  a.optional("corresponding", markers.corresponding);
  a.optional("scale", markers.scale);
  a.optional("rotate", markers.rotate);
  a.optional("move", markers.move);
  std::optional<int> bridge = markers.bridge == MarkersEdit{}.bridge ? std::nullopt : std::optional(markers.bridge);
  a.optional("bridge", bridge);
  a.place(markers.place);
  if constexpr (A::reading) {
    markers.bridge = bridge.value_or(MarkersEdit{}.bridge);
    const Json *scale = a.json().find("scale"), *matches = a.json().find("matches");
    if (scale != nullptr && !(*markers.scale > 0)) throw a.file().error(*scale, "a number above 0");
    if (bridge && *bridge < 0) throw a.file().error(*a.json().find("bridge"), "a whole number of at least 0");
    if (matches != nullptr && markers.matches.size() < 3)
      throw a.file().error(*matches, "at least 3 matches, which fix a rotation",
                           std::to_string(markers.matches.size()));
    if (markers.corresponding && matches == nullptr)
      throw a.file().error(*a.json().find("corresponding"), "\"matches\" beside it", "none");
    if (matches != nullptr && (markers.rotate || markers.move))
      throw a.file().error(a.json(), "\"matches\", or \"rotate\" and \"move\"", "both");
  }
}

template <class A>
static void fields(A& a, Is<Layer> auto& layer) {
  SettingsObject settings{layer.settings};
  bool off = !layer.on;
  a.optional("name", layer.name);
  a.optional("off", off);
  a.required("method", layer.method);
  a.optional("settings", settings);
  a.optional("frame", layer.frame);
  a.optional("path", layer.path);
  a.optional("cuts", layer.cuts);
  a.optional("tets", layer.tets);
  a.optional("markers", layer.markers);
  a.optional("nodes", layer.nodes);
  a.optional("fixed", layer.fixed);
  a.optional("handles", layer.handles);
  a.optional("rigid", layer.rigid);
  a.optional("stiffness", layer.stiffness);
  a.optional("examples", layer.examples);
  a.optional("example_weights", layer.example_weights);
  a.optional("examples_of", layer.examples_of);
  a.optional("keys", layer.keys);
  a.optional("start", layer.start);
  a.place(layer.place);
  if constexpr (A::reading) {
    layer.settings = std::move(settings.rows);
    layer.on = !off;
    check_keys(a, layer);
  }
}

static void check_hashes(const ObjectReader& reader, const Project& project) {
  const Json* json = reader.json().find("input_hashes");
  if (json == nullptr) return;
  if (project.hashes.of.size() != project.inputs.size())
    throw reader.file().error(*json, "as many hashes as \"inputs\", " + std::to_string(project.inputs.size()),
                              std::to_string(project.hashes.of.size()));
  for (std::size_t i = 0; i < project.hashes.of.size(); ++i)
    if (!is_input_hash(project.hashes.of[i]))
      throw reader.file().error(json->items()[i], "\"sha256:\" and 64 hexadecimal digits");
}

template <class A>
static void fields(A& a, Is<EditFile> auto& edit) {
  a.required("sinew", edit.version);
  if constexpr (A::reading)
    if (const Json* json = a.json().find("sinew"); json != nullptr && edit.version != 1)
      throw a.file().error(*json, "version 1 of the format");
  a.optional("inputs", edit.project.inputs);
  a.optional("input_hashes", edit.project.hashes.of);
  a.required("layers", edit.project.layers);
  if constexpr (A::reading) check_hashes(a, edit.project);
}

/// Applies `change` to every path of the project.
template <class Change>
static void change_paths(Project& project, const Change& change) {
  const auto visit = [&](Selection& selection) {
    if (auto* labels = std::get_if<SelectLabels>(&selection.what)) labels->path = change(labels->path);
  };
  for (std::string& path : project.inputs) path = change(path);
  for (Layer& layer : project.layers) {
    for (std::string& path : layer.examples) path = change(path);
    if (layer.markers) layer.markers->path = change(layer.markers->path);
    if (!layer.tets.empty()) layer.tets = change(layer.tets);
    if (!layer.examples_of.empty()) layer.examples_of = change(layer.examples_of);
    for (Selection& selection : layer.nodes) visit(selection);
    for (Selection& selection : layer.fixed) visit(selection);
    for (Selection& selection : layer.rigid) visit(selection);
    for (HandleEdit& handle : layer.handles) visit(handle.points);
    for (Stiffness& stiffness : layer.stiffness) visit(stiffness.points);
  }
}

Project parse_edit(const std::string& path, std::string text, const SharedArrays* arrays) {
  const JsonFile file(path, std::move(text), arrays);
  EditFile edit;
  read_value(file, file.root(), edit);
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  change_paths(edit.project, [&](const std::string& p) { return (folder / p).lexically_normal().string(); });
  return edit.project;
}

std::string edit_text(const std::string& path, const Project& project) {
  EditFile edit{1, project};
  const std::filesystem::path folder = std::filesystem::absolute(path).lexically_normal().parent_path();
  change_paths(edit.project, [&](const std::string& p) {
    const std::filesystem::path target(p);
    return target.is_absolute() ? p : std::filesystem::absolute(target).lexically_proximate(folder).string();
  });
  JsonWriter out;
  write_value(out, edit);
  return out.result();
}

std::string edit_text(const Project& project, SharedArrays& arrays) {
  EditFile edit{1, project};
  change_paths(edit.project, [](const std::string& p) {
    return p.empty() ? p : std::filesystem::absolute(p).lexically_normal().string();
  });
  JsonWriter out(&arrays);
  write_value(out, edit);
  return out.result();
}

Project read_edit(const std::string& path) {
  const std::vector<std::byte> bytes = io::load_bytes(path);
  return parse_edit(path, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

}  // namespace sinew::document
