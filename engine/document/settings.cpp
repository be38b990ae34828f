#include "engine/document/settings.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/io/text.h"

namespace sinew::document {

namespace {

/// "a", "b", "c"
template <class Range, class Name>
std::string list(const Range& range, const Name& name) {
  std::string text;
  for (const auto& row : range) text += (text.empty() ? "\"" : ", \"") + name(row) + "\"";
  return text;
}

const Setting* find(const Method& method, const std::string& name) {
  for (const Setting& setting : method.settings)
    if (setting.name == name) return &setting;
  return nullptr;
}

/// 100000 rather than 1e+05.
std::string plain(double x) {
  const bool whole = x == std::floor(x) && std::abs(x) < 1e15;
  return whole ? std::to_string(static_cast<std::int64_t>(x)) : io::shortest(x);
}

std::string allowed(const Setting& setting) {
  if (!setting.choices.empty()) return "one of " + list(setting.choices, [](const std::string& c) { return c; });
  return std::string(setting.integer ? "a whole number" : "a number") + " from " + plain(setting.min) + " to " +
         plain(setting.max);
}

double value_of(const SettingEdit& edit, const Setting& setting) {
  const std::string* text = std::get_if<std::string>(&edit.value);
  if (text != nullptr)
    for (std::size_t i = 0; i < setting.choices.size(); ++i)
      if (setting.choices[i] == *text) return static_cast<double>(i);
  const double* number = std::get_if<double>(&edit.value);
  const bool fits = setting.choices.empty() && number != nullptr && *number >= setting.min && *number <= setting.max &&
                    (!setting.integer || *number == std::floor(*number));
  if (!fits)
    throw place_error(edit.place, "setting " + setting.name, allowed(setting) + " for \"" + setting.name + "\"",
                      text != nullptr ? sinew::quoted(*text) : plain(*number));
  return *number;
}

std::size_t count_places(const Layer& layer) {
  return static_cast<std::size_t>(std::count_if(layer.handles.begin(), layer.handles.end(), [](const HandleEdit& h) {
    return std::holds_alternative<SelectPlaces>(h.points.what);
  }));
}

/// Parts of a layer that its method does not know: their name and how many the layer has.
void refuse_unknown_parts(const Layer& layer, const Method& method) {
  const std::tuple<const char*, bool, std::size_t> parts[] = {
      {"rigid", method.parts.rigid, layer.rigid.size()},
      {"stiffness", method.parts.stiffness, layer.stiffness.size()},
      {"examples", method.parts.examples, layer.examples.size()},
      {"example_weights", method.parts.examples, layer.example_weights.size()},
      {"examples_of", method.parts.examples, layer.examples_of.empty() ? 0 : 1},
      {"cuts", method.parts.cuts, layer.cuts.size()},
      {"path", method.parts.nodes, layer.path ? 1 : 0},
      {"nodes", method.parts.nodes, layer.nodes.size()},
      {"tets", method.parts.solid, layer.tets.empty() ? 0 : 1},
      {"markers", method.parts.places, layer.markers ? 1 : 0},
      {"places", method.parts.places, count_places(layer)}};
  for (const auto& [name, known, count] : parts)
    if (count > 0 && !known)
      throw place_error(layer.place, "layer", "no \"" + std::string(name) + "\" for method " + layer.method,
                        std::to_string(count));
}

}  // namespace

InputError place_error(const Place& place, const std::string& what, const std::string& expected,
                       const std::string& found) {
  return file_error(place.text.empty() ? what : place.text, expected, found);
}

bool same_structure(const Layer& a, const Layer& b) {
  return a.method == b.method && a.settings == b.settings && a.nodes == b.nodes && a.path == b.path &&
         a.cuts == b.cuts && a.tets == b.tets && a.examples == b.examples && a.examples_of == b.examples_of &&
         a.frame == b.frame;
}

const Method& method_of(const Layer& layer, std::span<const Method> methods) {
  for (const Method& method : methods)
    if (method.name == layer.method) return method;
  const std::string names = list(methods, [](const Method& m) { return m.name; });
  throw place_error(layer.place, "layer", "a method, one of " + names, sinew::quoted(layer.method));
}

Settings settings_of(const Layer& layer, const Method& method) {
  Settings out;
  for (const SettingEdit& edit : layer.settings) {
    const Setting* setting = find(method, edit.name);
    if (setting == nullptr) {
      const std::string names = list(method.settings, [](const Setting& s) { return s.name; });
      throw place_error(edit.place, "layer", "a setting of method " + method.name + ", one of " + names,
                        sinew::quoted(edit.name));
    }
    out.emplace_back(edit.name, value_of(edit, *setting));
  }
  return out;
}

void check_layers(std::span<const Layer> layers, std::span<const Method> methods) {
  for (const Layer& layer : layers) {
    if (!layer.on) continue;
    const Method& method = method_of(layer, methods);
    settings_of(layer, method);
    refuse_unknown_parts(layer, method);
  }
}

void set_from_text(const std::string& text, Project& project, std::span<const Method> methods) {
  const Place place{"--set " + text};
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0)
    throw place_error(place, "", "name=value or LAYER.name=value", sinew::quoted(text));
  std::string name = text.substr(0, equals);
  const std::string value = text.substr(equals + 1);
  std::int64_t only = 0;
  if (const std::size_t dot = name.find('.'); dot != std::string::npos && io::parse(name.substr(0, dot), only))
    name.erase(0, dot + 1);
  SettingEdit edit{name, value, place};
  if (double number = 0; io::parse(value, number)) edit.value = number;

  bool taken = false;
  for (std::size_t i = 0; i < project.layers.size(); ++i) {
    Layer& layer = project.layers[i];
    if (!layer.on || (only != 0 && only != static_cast<std::int64_t>(i) + 1)) continue;
    if (find(method_of(layer, methods), name) == nullptr) continue;
    std::erase_if(layer.settings, [&](const SettingEdit& row) { return row.name == name; });
    layer.settings.push_back(edit);
    taken = true;
  }
  if (!taken)
    throw place_error(place, "", "a setting of a layer's method (sinew methods lists them)", sinew::quoted(name));
}

}  // namespace sinew::document
