#include "engine/document/report.h"

#include <algorithm>
#include <cmath>

#include "engine/geometry/topology.h"

namespace sinew::document {

namespace {

template <class T>
void member(JsonWriter& out, const std::string& name, const T& value) {
  out.key(name);
  write_value(out, value);
}

/// Counts are whole numbers in doubles. Those of the solve come first; each name once.
void write_counts(JsonWriter& out, const LayerReport& layer) {
  std::vector<std::string> written;
  for (const Figures* figures : {&layer.solve.counts, &layer.counts})
    for (const auto& [name, value] : *figures) {
      if (std::find(written.begin(), written.end(), name) != written.end()) continue;
      written.push_back(name);
      member(out, name, static_cast<std::size_t>(value));
    }
}

void begin(JsonWriter& out, const std::string& name) {
  out.key(name);
  out.begin_object();
}

void write_quality(JsonWriter& out, const Quality& quality) {
  begin(out, "quality");
  if (quality.has_edges) {
    member(out, "edge_rms", quality.edge_rms);
    member(out, "edge_max", quality.edge_max);
  }
  if (quality.closed) member(out, "volume_change", quality.volume_change);
  out.end_object();
}

void write_seconds(JsonWriter& out, const LayerReport& layer) {
  begin(out, "seconds");
  member(out, "build", layer.build);
  member(out, "bind", layer.bind);
  member(out, "prefactor", layer.solve.prefactor_seconds);
  member(out, "solve", layer.solve.solve_seconds);
  if (layer.solve.iterations > 0) member(out, "per_iteration", layer.solve.solve_seconds / layer.solve.iterations);
  member(out, "skin", layer.skin);
  out.end_object();
}

void write_handles(JsonWriter& out, const LayerReport& layer) {
  if (layer.handles.empty()) return;
  out.key("handles");
  out.begin_array(false);
  for (const HandleReport& handle : layer.handles) {
    out.begin_object();
    if (!handle.name.empty()) member(out, "name", handle.name);
    member(out, "points", handle.points);
    member(out, "max", handle.max);
    member(out, "rms", handle.rms);
    out.end_object();
  }
  out.end_array();
}

void write_layer(JsonWriter& out, const LayerReport& layer) {
  out.begin_object();
  member(out, "method", layer.method);
  member(out, "status", name_of(layer.solve.status));
  if (!layer.solve.message.empty()) member(out, "message", layer.solve.message);
  member(out, "iterations", layer.solve.iterations);
  if (!layer.notes.empty()) {
    out.key("notes");
    out.begin_array(false);
    for (const std::string& note : layer.notes) out.text(note);
    out.end_array();
  }
  write_counts(out, layer);
  begin(out, "energy");
  for (const auto& [name, value] : layer.solve.energy) member(out, name, value);
  out.end_object();
  begin(out, "handle_error");
  member(out, "max", layer.handle_max);
  member(out, "rms", layer.handle_rms);
  out.end_object();
  write_handles(out, layer);
  member(out, "example_weights", layer.solve.example_weights);
  write_quality(out, layer.quality);
  write_seconds(out, layer);
  out.end_object();
}

}  // namespace

void add_frame(LayerReport& all, const LayerReport& frame) {
  const auto total = [](const LayerReport& r) { return r.solve.energy.empty() ? 0 : r.solve.energy.front().second; };
  if (frame.solve.status > all.solve.status) {
    all.solve.status = frame.solve.status;
    all.solve.message = frame.solve.message;
  }
  if (total(frame) > total(all)) all.solve.energy = frame.solve.energy;
  all.solve.iterations += frame.solve.iterations;
  all.solve.prefactor_seconds += frame.solve.prefactor_seconds;
  all.solve.solve_seconds += frame.solve.solve_seconds;
  all.handle_max = std::max(all.handle_max, frame.handle_max);
  all.handle_rms = std::max(all.handle_rms, frame.handle_rms);
  for (std::size_t h = 0; h < std::min(all.handles.size(), frame.handles.size()); ++h) {
    all.handles[h].max = std::max(all.handles[h].max, frame.handles[h].max);
    all.handles[h].rms = std::max(all.handles[h].rms, frame.handles[h].rms);
  }
  all.quality.edge_rms = std::max(all.quality.edge_rms, frame.quality.edge_rms);
  all.quality.edge_max = std::max(all.quality.edge_max, frame.quality.edge_max);
  if (std::abs(frame.quality.volume_change) > std::abs(all.quality.volume_change))
    all.quality.volume_change = frame.quality.volume_change;
  all.skin += frame.skin;
}

InputReport report_of(const Shape& input) {
  return {
      representation(input), input.size(), input.faces.size(), input.tets.size(), connected_components(input).count, 1};
}

void write_members(JsonWriter& out, const InputReport& input) {
  member(out, "representation", input.representation);
  member(out, "points", input.points);
  member(out, "faces", input.faces);
  member(out, "tets", input.tets);
  member(out, "components", input.components);
  member(out, "frames", input.frames);
}

std::string report_text(const Report& report) {
  JsonWriter out;
  out.begin_object();
  begin(out, "input");
  write_members(out, report.input);
  out.end_object();
  out.key("layers");
  out.begin_array(false);
  for (const LayerReport& layer : report.layers) write_layer(out, layer);
  out.end_array();
  begin(out, "seconds");
  member(out, "read", report.read);
  member(out, "write", report.write);
  member(out, "total", report.total);
  out.end_object();
  out.end_object();
  return out.result();
}

}  // namespace sinew::document
