// GraphInfluence as the tables of a pose file, and back.

#include <cmath>

#include "deformers/graph_influence.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

using Table = Deformer::Table;

const Table* find(const std::vector<Table>& tables, const std::string& name, int columns) {
  for (const Table& table : tables)
    if (table.name == name && table.columns == columns) return &table;
  return nullptr;
}

std::vector<Vec3> points_of(const Table& table) {
  if (table.values.size() % 3 != 0) throw InputError("table \"" + table.name + "\": expected rows of three numbers");
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < table.values.size(); i += 3) {
    points.emplace_back(table.values[i], table.values[i + 1], table.values[i + 2]);
    if (!points.back().allFinite())
      throw InputError("table \"" + table.name + "\": expected finite numbers, found row " + std::to_string(i / 3));
  }
  return points;
}

/// Counts that together make `total`.
std::vector<std::size_t> counts_of(const Table& table, std::size_t total) {
  std::vector<std::size_t> counts;
  std::size_t left = total;
  for (const double x : table.values) {
    if (!(x >= 0 && x <= static_cast<double>(left)) || x != std::floor(x)) break;
    counts.push_back(static_cast<std::size_t>(x));
    left -= counts.back();
  }
  if (left > 0 || counts.size() != table.values.size())
    throw InputError("table \"" + table.name + "\": expected counts that sum to " + std::to_string(total));
  return counts;
}

std::vector<Cut> cuts_of(const Table& table, const Table& lengths) {
  std::vector<Cut> cuts;
  std::size_t row = 0;
  for (const std::size_t length : counts_of(lengths, table.values.size() / 6)) {
    Cut cut;
    for (std::size_t i = 0; i < length; ++i, ++row) {
      const double* v = &table.values[6 * row];
      cut.path.emplace_back(v[0], v[1], v[2]);
      cut.depth = Vec3(v[3], v[4], v[5]);
    }
    cuts.push_back(std::move(cut));
  }
  return cuts;
}

SkinWeights rows_of(const Table& rows, const Table& influences, std::size_t nodes) {
  SkinWeights weights;
  const std::vector<std::size_t> counts = counts_of(rows, influences.values.size() / 2);
  for (std::size_t i = 0; i < influences.values.size(); i += 2) {
    const double node = influences.values[i], weight = influences.values[i + 1];
    if (!(node >= 0 && node < static_cast<double>(nodes)) || node != std::floor(node) || !(weight > 0 && weight <= 1))
      throw InputError("table \"" + influences.name + "\": expected a node from 0 to " + std::to_string(nodes - 1) +
                       " and a weight from 0 to 1, found others in row " + std::to_string(i / 2));
    weights.maps.push_back(static_cast<Index>(node));
    weights.weights.push_back(static_cast<float>(weight));
  }
  for (const std::size_t count : counts) weights.offsets.push_back(weights.offsets.back() + count);
  return weights;
}

void append(Table& table, const Vec3& p) {
  table.values.insert(table.values.end(), p.data(), p.data() + 3);
}

}  // namespace

std::vector<Table> GraphInfluence::tables() const {
  Table nodes{"nodes", 3, {}};
  for (const Vec3& g : nodes_.points()) append(nodes, g);
  std::vector<Table> out{std::move(nodes), {"neighbours", 1, {static_cast<double>(options_.neighbours)}}};
  if (!options_.cuts.empty()) {
    Table cuts{"cuts", 6, {}}, lengths{"cut_lengths", 1, {}};
    for (const Cut& cut : options_.cuts) {
      lengths.values.push_back(static_cast<double>(cut.path.size()));
      for (const Vec3& p : cut.path) {
        append(cuts, p);
        append(cuts, cut.depth);
      }
    }
    out.push_back(std::move(cuts));
    out.push_back(std::move(lengths));
  }
  if (sample_.size() == 0) return out;
  Table points{"points", 3, {}}, rows{"points_rows", 1, {}}, influences{"points_influences", 2, {}};
  for (const Vec3& p : sample_.points()) append(points, p);
  for (std::size_t i = 0; i < sample_weights_.size(); ++i)
    rows.values.push_back(static_cast<double>(sample_weights_.offsets[i + 1] - sample_weights_.offsets[i]));
  for (std::size_t e = 0; e < sample_weights_.influences(); ++e) {
    influences.values.push_back(sample_weights_.maps[e]);
    influences.values.push_back(static_cast<double>(sample_weights_.weights[e]));
  }
  for (Table* table : {&points, &rows, &influences}) out.push_back(std::move(*table));
  return out;
}

GraphInfluence GraphInfluence::from_tables(const std::vector<Table>& tables) {
  const Table *nodes = find(tables, "nodes", 3), *neighbours = find(tables, "neighbours", 1);
  if (nodes == nullptr || nodes->values.empty())
    throw InputError("expected a table \"nodes\" of three columns, found none");
  if (neighbours == nullptr || neighbours->values.size() != 1 ||
      !(neighbours->values[0] >= 1 && neighbours->values[0] <= 1000))
    throw InputError("expected a table \"neighbours\" with one number from 1 to 1000, found none");
  InfluenceOptions options;
  options.neighbours = static_cast<int>(neighbours->values[0]);
  if (const Table* cuts = find(tables, "cuts", 6)) {
    const Table* lengths = find(tables, "cut_lengths", 1);
    if (lengths == nullptr) throw InputError("expected a table \"cut_lengths\" beside \"cuts\", found none");
    options.cuts = cuts_of(*cuts, *lengths);
  }
  const Table* points = find(tables, "points", 3);
  options.surface = points != nullptr;
  GraphInfluence influence(points_of(*nodes), std::move(options));
  if (points == nullptr) return influence;
  const Table *rows = find(tables, "points_rows", 1), *influences = find(tables, "points_influences", 2);
  if (rows == nullptr || influences == nullptr || rows->values.size() * 3 != points->values.size())
    throw InputError("expected tables \"points_rows\", one for each of \"points\", and \"points_influences\"");
  influence.sample_ = NearestTree(points_of(*points));
  influence.sample_weights_ = rows_of(*rows, *influences, influence.nodes_.size());
  return influence;
}

}  // namespace sinew
