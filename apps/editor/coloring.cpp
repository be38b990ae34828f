#include "apps/editor/coloring.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "apps/editor/session.h"
#include "apps/editor/view.h"

namespace sinew::editor {

namespace {

constexpr gpu::PointColor plain{204, 202, 198, 0};
constexpr std::array<gpu::PointColor, 6> tints{{{206, 203, 198, 0},
                                                {198, 205, 210, 0},
                                                {204, 208, 196, 0},
                                                {211, 200, 197, 0},
                                                {201, 199, 211, 0},
                                                {194, 207, 204, 0}}};
constexpr gpu::PointColor no_number{120, 122, 126, 0};

bool is_colors(const Attribute& attribute, const Shape& shape) {
  return attribute.per_point() && attribute.count() == shape.size() && attribute.kind == Kind::Color &&
         attribute.components >= 3;
}

/// What stands for full brightness in a colour attribute.
double full_scale(const Attribute& attribute) {
  switch (attribute.type) {
    case Type::UInt8: return 255;
    case Type::UInt16: return 65535;
    default: break;
  }
  double largest = 0;
  for (std::size_t i = 0; i < attribute.count(); ++i)
    for (int c = 0; c < 3; ++c) largest = std::max(largest, attribute.number(i, c));
  return largest > 1 ? 255 : 1;  // written as 0..1 or as 0..255
}

void color_by_colors(const Attribute& attribute, std::vector<gpu::PointColor>& colors) {
  const double scale = 255 / full_scale(attribute);
  for (std::size_t i = 0; i < colors.size(); ++i) {
    const auto channel = [&](int c) {
      const double value = attribute.number(i, c) * scale;
      return static_cast<std::uint8_t>(value > 0 ? std::min(255.0, value) + 0.5 : 0);
    };
    colors[i] = {channel(0), channel(1), channel(2), 0};
  }
}

/// The chosen layer's answer; null where there is none.
const document::LayerResult* chosen_result(const Session& session) {
  for (const document::LayerResult& result : session.shown())
    if (result.layer == session.chosen_layer() && result.weights != nullptr && result.pose != nullptr) return &result;
  return nullptr;
}

}  // namespace

std::vector<std::string> color_choices(const Shape& shape) {
  std::vector<std::string> names;
  for (const Attribute& attribute : shape.attributes) {
    const bool number = attribute.per_point() && attribute.count() == shape.size() && attribute.components == 1 &&
                        (attribute.kind == Kind::Scalar || attribute.kind == Kind::Id);
    if (number || is_colors(attribute, shape)) names.push_back(attribute.name);
  }
  return names;
}

Coloring plain_coloring(const Shape& shape, const std::string& attribute) {
  Coloring out;
  out.colors.assign(shape.size(), plain);
  for (std::size_t part = 0; part < shape.parts.size(); ++part)
    std::fill_n(out.colors.begin() + shape.parts[part].first, shape.parts[part].count, tints[part % tints.size()]);
  if (attribute.empty()) return out;
  const Attribute* found = shape.find(attribute);
  if (found != nullptr && is_colors(*found, shape)) {
    color_by_colors(*found, out.colors);
    return out;
  }
  out.field = document::field_of(shape, attribute);
  if (out.field) out.extent = document::extent_of(out.field->values);
  return out;
}

gpu::Colormap usual_map(const document::Field& field) {
  return field.scale == document::Field::Scale::Signed ? gpu::Colormap::CoolWarm : gpu::Colormap::Viridis;
}

void paint(Coloring& coloring, std::optional<gpu::Colormap> map, std::optional<document::ValueRange> range) {
  if (!coloring.field) return;
  const document::Field& field = *coloring.field;
  coloring.map = map.value_or(usual_map(field));
  coloring.usual = document::usual_range(field.values, field.scale, coloring.map == gpu::Colormap::CoolWarm);
  coloring.range = range.value_or(coloring.usual);
  // A table: the colours of a million points in a millisecond or two.
  constexpr int steps = 1024;
  std::array<gpu::PointColor, steps + 1> table;
  for (int i = 0; i <= steps; ++i)
    table[static_cast<std::size_t>(i)] = gpu::color_at(coloring.map, static_cast<double>(i) / steps);
  const double span = coloring.range.high - coloring.range.low;
  const auto low = static_cast<float>(coloring.range.low);
  const float scale = span > 0 ? static_cast<float>(steps / span) : 0;
  coloring.colors.resize(field.values.size());
  for (std::size_t i = 0; i < coloring.colors.size(); ++i) {
    const float value = field.values[i];
    const float at = std::clamp((value - low) * scale + 0.5f, 0.0f, static_cast<float>(steps));
    coloring.colors[i] = std::isfinite(value) ? table[static_cast<std::size_t>(at)] : no_number;
  }
}

std::optional<Index> influencing_map(const Session& session, const View& view) {
  const document::LayerResult* result = chosen_result(session);
  if (result == nullptr) return std::nullopt;
  const std::optional<std::size_t> handle = session.chosen_handle();
  if (handle && result->of_frame && *handle < result->constraints.handles.size() &&
      !result->constraints.handles[*handle].points.empty())
    return document::strongest_map(*result->weights, result->constraints.handles[*handle].points);
  if (!view.clicked || *view.clicked >= result->weights->size()) return std::nullopt;
  const Index point = *view.clicked;
  return document::strongest_map(*result->weights, std::span(&point, 1));
}

bool Painter::poll() {
  std::optional<Background::Outcome> outcome = work_.take();
  if (outcome && outcome->finish) outcome->finish();
  return outcome.has_value();
}

bool Painter::update(Session& session, const View& view) {
  poll();
  const bool other_map = view.colormap != map_ || view.color_range != range_;
  map_ = view.colormap;
  range_ = view.color_range;
  if (view.heat && update_heat(session, view)) return true;
  // The colours of the frame before stay until those of this one are there.
  if (view.heat && hot_ && coloring_.colors.size() == session.input()->size()) {
    if (other_map) paint(coloring_, map_, range_);
    return other_map;
  }
  // Another input, another attribute, or a heat map that is still to come: plain until then.
  const std::string attribute = view.heat ? "" : view.color_by;
  if (painted_ == session.input() && attribute_ == attribute && !hot_) {
    if (other_map) paint(coloring_, map_, range_);
    return other_map && coloring_.field.has_value();
  }
  coloring_ = plain_coloring(*session.input(), attribute);
  paint(coloring_, map_, range_);
  painted_ = session.input();
  attribute_ = attribute;
  hot_ = false;
  return true;
}

/// True where a newer heat map has taken the place of the colours.
bool Painter::update_heat(Session& session, const View& view) {
  Source wanted{session.input(), *view.heat, session.bent_version(), session.chosen_layer(), 0};
  const std::optional<Index> map = influencing_map(session, view);
  if (wanted.kind == document::FieldKind::Influence) wanted.map = map.value_or(~Index{0});
  if (!work_.busy() && begun_ != wanted) begin(session, wanted);
  if (!found_) return false;
  Found found = std::move(*std::exchange(found_, std::nullopt));
  // An older pose of what is wanted is shown all the same: while a drag runs there is always a newer one.
  if (found.source.input != wanted.input || found.source.kind != wanted.kind) return false;
  coloring_.field = std::move(found.field);
  coloring_.extent = found.extent;
  paint(coloring_, map_, range_);
  painted_ = session.input();
  hot_ = true;
  return true;
}

void Painter::begin(Session& session, const Source& wanted) {
  begun_ = wanted;
  // Energy and influence are the chosen layer's; the others are of all layers together.
  std::vector<document::LayerResult> layers;
  const bool one = wanted.kind == document::FieldKind::Energy || wanted.kind == document::FieldKind::Influence;
  for (const document::LayerResult& layer : session.shown()) {
    if (one && layer.layer != wanted.layer) continue;
    document::LayerResult used;  // without constraints, which may be long lists
    used.layer = layer.layer;
    used.weights = layer.weights;
    used.pose = layer.pose;
    used.map_energy = layer.map_energy;
    layers.push_back(std::move(used));
  }
  work_.start("Colouring", false, [this, wanted, layers](const Tell&) -> Background::Finish {
    auto found = std::make_shared<Found>();
    found->source = wanted;
    found->field = document::field_of(wanted.kind, wanted.input->positions, layers, wanted.map);
    found->extent = document::extent_of(found->field.values);
    return [this, found] { found_ = std::move(*found); };
  });
}

}  // namespace sinew::editor
