#include "engine/document/pose_file.h"

#include <algorithm>

#include "engine/document/json.h"
#include "engine/document/settings.h"
#include "engine/geometry/skin.h"

namespace sinew::document {

template <>
inline constexpr bool is_object<Deformer::Table> = true;
template <>
inline constexpr bool is_object<SolvedLayer> = true;
template <>
inline constexpr bool is_object<SolvedEdit> = true;

template <class A, class T>
static void fields(A& a, T& table) requires std::is_same_v<std::remove_const_t<T>, Deformer::Table> {
  a.required("name", table.name);
  a.required("columns", table.columns);
  a.required("values", table.values);
  if constexpr (A::reading) {
    if (table.columns < 1 || table.values.size() % static_cast<std::size_t>(table.columns) != 0)
      throw a.file().error(a.json(), "rows of whole \"columns\"",
                           std::to_string(table.values.size()) + " values in " + std::to_string(table.columns));
  }
}

template <class A, class T>
static void fields(A& a, T& layer) requires std::is_same_v<std::remove_const_t<T>, SolvedLayer> {
  a.required("method", layer.method);
  a.required("binding", layer.binding);
  a.required("maps", layer.maps);
}

template <class A, class T>
static void fields(A& a, T& edit) requires std::is_same_v<std::remove_const_t<T>, SolvedEdit> {
  int version = 1;
  a.required("sinew_pose", version);
  if constexpr (A::reading)
    if (const Json* json = a.json().find("sinew_pose"); json != nullptr && version != 1)
      throw a.file().error(*json, "version 1 of the format");
  a.required("origin", edit.origin);
  a.required("layers", edit.layers);
}

SolvedEdit solved_edit(const Evaluation& evaluation, std::span<const Layer> layers) {
  SolvedEdit out{evaluation.shape->origin, {}};
  for (std::size_t i = 0; i < evaluation.layers.size(); ++i) {
    const LayerResult& result = evaluation.layers[i];
    out.layers.push_back({layers[result.layer].method, evaluation.bindings[i], *result.pose});
  }
  return out;
}

std::string solved_edit_text(const SolvedEdit& edit) {
  JsonWriter out;
  write_value(out, edit);
  return out.result();
}

SolvedEdit parse_solved_edit(const std::string& path, std::string text) {
  const JsonFile file(path, std::move(text));
  SolvedEdit edit;
  read_value(file, file.root(), edit);
  return edit;
}

PoseApplier::PoseApplier(const SolvedEdit& edit, std::span<const Method> methods, const Vec3& origin)
    : offset_(origin - edit.origin) {
  for (std::size_t i = 0; i < edit.layers.size(); ++i) {
    const SolvedLayer& solved = edit.layers[i];
    Layer named;
    named.method = solved.method;
    LayerMaps layer{&method_of(named, methods), solved.binding, solved.maps};
    // A' (p + offset) - offset = A p + t + (A - I) offset: the unit map stays exactly that.
    for (Affine& map : layer.maps) map.col(3) += (map.leftCols<3>() - Mat3::Identity()) * offset_;
    layers_.push_back(std::move(layer));
  }
  Shape probe;
  probe.origin = origin;
  probe.positions = {Vec3(0, 0, 0)};
  apply(probe);  // tables that do not fit are refused here, before anything is written
}

Shape PoseApplier::apply(const Shape& shape) const {
  Shape out = shape;
  std::vector<Vec3> points(shape.size());
  const Gradients gradients = needs_gradients(shape) ? Gradients::Yes : Gradients::No;
  for (const LayerMaps& layer : layers_) {
    for (std::size_t i = 0; i < points.size(); ++i) points[i] = out.positions[i] + offset_;
    const SkinWeights weights = layer.method->bind(layer.binding, points, gradients);
    const auto highest = std::max_element(weights.maps.begin(), weights.maps.end());
    if (highest != weights.maps.end() && *highest >= layer.maps.size())
      throw InputError("expected more than " + std::to_string(*highest) +
                       " maps, one for each that points follow, found " + std::to_string(layer.maps.size()));
    out = skin(out, weights, layer.maps);
  }
  return out;
}

}  // namespace sinew::document
