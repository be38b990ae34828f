#include "deformers/tet_mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "deformers/tet_decimate.h"
#include "deformers/tet_process.h"
#include "deformers/tet_surface.h"
#include "deformers/tet_surface_edges.h"
#include "engine/geometry/error.h"

namespace sinew {

namespace {

/// A power of two that brings the surface's size near 1, where TetGen's tolerances are meant to be used.
double unit_scale(const std::vector<Vec3>& points) {
  double largest = 0;
  for (const Vec3& p : points) largest = std::max(largest, p.cwiseAbs().maxCoeff());
  int exponent = 0;
  std::frexp(largest, &exponent);
  return std::ldexp(1.0, -exponent);
}

InputError crossing_error(const Shape& shape, const TetSurface& surface, const std::vector<Index>& triangles) {
  std::vector<Index> faces;
  for (const Index t : triangles)
    if (surface.faces[t] != TetSurface::no_face) faces.push_back(surface.faces[t]);
  std::sort(faces.begin(), faces.end());
  faces.erase(std::unique(faces.begin(), faces.end()), faces.end());
  const Triangle& first = surface.triangles[triangles[0]];
  const Vec3 place = (surface.vertices[first[0]] + surface.vertices[first[1]] + surface.vertices[first[2]]) / 3;
  return InputError("expected faces that do not cross, found that " +
                    (faces.empty()
                         ? "the faces that close holes cross each other"
                         : counted(faces.size(), "face crosses", "faces cross") + " others: " + list_text(faces)) +
                    ", the first around " + place_text(shape, place));
}

/// Volumes of the regions, which must be the surface's: each as often as the surface winds around it. Keeps the tets of
/// those that it winds around at all.
void keep_solid(const TetSurface& surface, const TetAnswer& answer, TetMesh& mesh) {
  const std::size_t count =
      answer.regions.empty() ? 0 : *std::max_element(answer.regions.begin(), answer.regions.end());
  if (count > answer.tets.size() + 1)
    throw InputError("expected regions of tets, found one numbered " + std::to_string(count));
  std::vector<double> volumes(count + 1, 0), largest(count + 1, 0);
  std::vector<Index> of(count + 1, 0);
  for (Index t = 0; t < answer.tets.size(); ++t) {
    const Tet& tet = answer.tets[t];
    const double volume =
        tet_volume(mesh.vertices[tet[0]], mesh.vertices[tet[1]], mesh.vertices[tet[2]], mesh.vertices[tet[3]]);
    if (!(volume > 0))
      throw InputError("expected tets of positive volume, found tet " + std::to_string(t) + " without");
    volumes[answer.regions[t]] += volume;
    if (volume <= largest[answer.regions[t]]) continue;
    largest[answer.regions[t]] = volume;
    of[answer.regions[t]] = t;
  }
  double sum = 0;
  std::vector<int> winding(count + 1, 0);
  for (std::size_t r = 0; r <= count; ++r) {
    if (volumes[r] == 0) continue;
    const Tet& tet = answer.tets[of[r]];
    winding[r] = winding_number(
        surface, (mesh.vertices[tet[0]] + mesh.vertices[tet[1]] + mesh.vertices[tet[2]] + mesh.vertices[tet[3]]) / 4);
    sum += winding[r] * volumes[r];
  }
  const double enclosed = enclosed_volume(surface);
  if (!(std::abs(sum - enclosed) <= 1e-9 * std::abs(enclosed)))
    throw InputError("expected tets of the volume that the faces enclose, " + number_text(enclosed) + ", found " +
                     number_text(sum));
  for (Index t = 0; t < answer.tets.size(); ++t)
    if (winding[answer.regions[t]] != 0) mesh.tets.push_back(answer.tets[t]);
}

/// Triangles of the surface that are no side of a tet.
std::size_t lost_faces(const TetSurface& surface, const TetAnswer& answer) {
  const auto sorted = [](Triangle corners) {
    std::sort(corners.begin(), corners.end());
    return corners;
  };
  std::vector<Triangle> sides;
  sides.reserve(4 * answer.tets.size());
  for (const auto& [a, b, c, d] : answer.tets)
    for (const Triangle& side : {Triangle{a, b, c}, Triangle{a, b, d}, Triangle{a, c, d}, Triangle{b, c, d}})
      if (std::max({side[0], side[1], side[2]}) < surface.vertices.size()) sides.push_back(sorted(side));
  std::sort(sides.begin(), sides.end());
  return static_cast<std::size_t>(std::count_if(
      surface.triangles.begin(), surface.triangles.end(),
      [&](const Triangle& triangle) { return !std::binary_search(sides.begin(), sides.end(), sorted(triangle)); }));
}

/// Leaves out added vertices of no tet (inside a cavity).
void drop_unused(TetMesh& mesh) {
  std::vector<Index> number(mesh.vertices.size(), 0);
  for (const Tet& tet : mesh.tets)
    for (const Index v : tet) number[v] = 1;
  std::size_t kept = 0, points = 0;
  for (std::size_t v = 0; v < number.size(); ++v) {
    if (number[v] == 0) continue;
    if (v < mesh.points.size()) mesh.points[points++] = mesh.points[v];
    mesh.vertices[kept] = mesh.vertices[v];
    number[v] = static_cast<Index>(kept++);
  }
  mesh.vertices.resize(kept);
  mesh.points.resize(points);
  for (Tet& tet : mesh.tets)
    for (Index& v : tet) v = number[v];
}

struct Work {
  const Shape& shape;
  const TetMeshOptions& options;
  TetLimits limits;
  std::function<bool(double)> progress;
  std::vector<std::string>& notes;
};

std::optional<TetAnswer> run(const Work& work, tets::Job job, const TetSurface& surface) {
  std::vector<Vec3> scaled = surface.vertices;
  const double scale = unit_scale(surface.vertices);
  for (Vec3& p : scaled) p *= scale;
  std::optional<TetAnswer> answer = run_tets(job, scaled, surface.triangles, work.limits, work.progress);
  if (answer)
    for (Vec3& p : answer->added) p /= scale;
  return answer;
}

/// Throws where faces cross; `why` the tets are missing is told where none do. Returns where progress said false.
void explain(const Work& work, const TetSurface& surface, const std::string& why) {
  const std::optional<TetAnswer> answer = run(work, tets::Job::Crossings, surface);
  if (!answer) return;
  if (!answer->crossing.empty()) throw crossing_error(work.shape, surface, answer->crossing);
  const bool known = answer->how == TetAnswer::How::Done;
  throw InputError("expected tets, found " + (why.empty() ? "none" : why) + (known ? ", though no faces cross" : ""));
}

TetMesh checked(const Work& work, const TetSurface& surface, const TetAnswer& answer) {
  TetMesh mesh;
  mesh.vertices = surface.vertices;
  mesh.points = surface.points;
  mesh.vertices.insert(mesh.vertices.end(), answer.added.begin(), answer.added.end());
  keep_solid(surface, answer, mesh);
  if (const std::size_t lost = lost_faces(surface, answer); lost > 0)
    work.notes.push_back(counted(lost, "triangle", "triangles") + " of the surface cut into smaller ones");
  drop_unused(mesh);
  return mesh;
}

bool has_tets(const TetAnswer& answer) {
  return answer.how == TetAnswer::How::Done && !answer.tets.empty();
}

/// Null where progress said false.
std::optional<TetMesh> filled(const Work& work, const TetSurface& surface) {
  const std::optional<TetAnswer> answer =
      run(work, work.options.inside ? tets::Job::FillInside : tets::Job::Fill, surface);
  if (answer && has_tets(*answer)) return checked(work, surface, *answer);
  if (answer) explain(work, surface, answer->why);
  return std::nullopt;
}

/// A decimated surface may cross itself; one with more vertices is tried then. Null where progress said false.
std::optional<TetMesh> filled_decimated(const Work& work, const TetSurface& surface) {
  const std::size_t all = surface.vertices.size();
  std::size_t wanted = static_cast<std::size_t>(std::max(work.options.vertices, 4));
  bool cancelled = false;
  const auto go_on = [&] {
    cancelled = cancelled || (work.progress && !work.progress(0));
    return !cancelled && std::chrono::steady_clock::now() < work.limits.end;
  };
  std::string tried;
  for (int attempt = 0; attempt < 5 && wanted < all; ++attempt, wanted += wanted / 2) {
    const TetSurface coarse = decimated_surface(surface, wanted, go_on);
    if (cancelled) return std::nullopt;
    const std::string count = std::to_string(coarse.vertices.size());
    if (is_closed(coarse)) {
      const std::optional<TetAnswer> answer =
          run(work, work.options.inside ? tets::Job::FillInside : tets::Job::Fill, coarse);
      if (!answer) return std::nullopt;
      if (has_tets(*answer)) {
        work.notes.push_back(std::to_string(all) + " vertices decimated to " + count +
                             (tried.empty() ? "" : "; to " + tried + " the faces crossed"));
        return checked(work, coarse, *answer);
      }
    }
    tried += (tried.empty() ? "" : ", ") + count;
  }
  const std::optional<TetAnswer> answer = run(work, tets::Job::Crossings, surface);
  if (!answer) return std::nullopt;
  if (!answer->crossing.empty()) throw crossing_error(work.shape, surface, answer->crossing);
  throw InputError("expected faces that do not cross when decimated, found that they do with " + tried + " of " +
                   std::to_string(all) + " vertices; more vertices keep them apart");
}

}  // namespace

double tet_volume(const Vec3& p0, const Vec3& p1, const Vec3& p2, const Vec3& p3) {
  return (p1 - p0).cross(p2 - p0).dot(p3 - p0) / 6;
}

TetMesh::Boundary TetMesh::boundary() const {
  struct Side {
    Triangle key, face;
    Index tet;
  };
  std::vector<Side> sides;
  sides.reserve(4 * tets.size());
  for (Index t = 0; t < tets.size(); ++t) {
    const auto [a, b, c, d] = tets[t];
    for (const Triangle& face : {Triangle{a, c, b}, Triangle{a, b, d}, Triangle{a, d, c}, Triangle{b, c, d}}) {
      Triangle key = face;
      std::sort(key.begin(), key.end());
      sides.push_back({key, face, t});
    }
  }
  std::sort(sides.begin(), sides.end(),
            [](const Side& a, const Side& b) { return std::pair(a.key, a.tet) < std::pair(b.key, b.tet); });
  Boundary boundary;
  for (std::size_t k = 0; k < sides.size(); ++k) {
    if ((k > 0 && sides[k - 1].key == sides[k].key) || (k + 1 < sides.size() && sides[k + 1].key == sides[k].key))
      continue;
    boundary.faces.push_back(sides[k].face);
    boundary.tets.push_back(sides[k].tet);
  }
  return boundary;
}

std::optional<TetMesh> tetrahedralized(const Shape& shape, const TetMeshOptions& options,
                                       std::vector<std::string>& notes, const std::function<bool(double)>& progress) {
  const auto end = std::chrono::steady_clock::now() +
                   std::chrono::duration_cast<std::chrono::steady_clock::duration>(
                       std::chrono::duration<double>(options.max_seconds < 1e6 ? options.max_seconds : 1e6));
  const TetLimits limits{end, options.max_seconds, options.max_bytes};
  const Work work{shape, options, limits, progress, notes};
  const TetSurface surface = closed_surface(shape, options.close_holes, notes);
  const bool small = static_cast<std::ptrdiff_t>(surface.vertices.size()) <= options.vertices;
  return small ? filled(work, surface) : filled_decimated(work, surface);
}

TetMesh tet_mesh_of(const Shape& shape, std::vector<std::string>& notes) {
  TetMesh mesh;
  std::size_t turned = 0, flat = 0;
  std::vector<Index> number(shape.size(), ~Index{0});
  for (std::size_t t = 0; t < shape.tets.size(); ++t) {
    Tet tet = shape.tets[t];
    for (const Index corner : tet)
      if (corner >= shape.size())
        throw InputError("expected tets over " + counted(shape.size(), "point", "points") + ", found point " +
                         std::to_string(corner) + " in tet " + std::to_string(t));
    const double volume =
        tet_volume(shape.positions[tet[0]], shape.positions[tet[1]], shape.positions[tet[2]], shape.positions[tet[3]]);
    if (!(std::abs(volume) > 0) || !std::isfinite(volume)) {
      ++flat;
      continue;
    }
    if (volume < 0) {
      std::swap(tet[2], tet[3]);
      ++turned;
    }
    for (const Index corner : tet) number[corner] = 0;
    mesh.tets.push_back(tet);
  }
  if (mesh.tets.empty())
    throw InputError("expected tets of a volume, found " +
                     (shape.tets.empty() ? "none" : "that all " + std::to_string(flat) + " have none"));
  for (Index i = 0; i < number.size(); ++i) {
    if (number[i] != 0) continue;
    number[i] = static_cast<Index>(mesh.points.size());
    mesh.points.push_back(i);
    mesh.vertices.push_back(shape.positions[i]);
  }
  for (Tet& tet : mesh.tets)
    for (Index& v : tet) v = number[v];
  if (turned > 0) notes.push_back(counted(turned, "tet", "tets") + " turned, whose volume was negative");
  if (flat > 0) notes.push_back(counted(flat, "tet", "tets") + " without volume left out");
  return mesh;
}

}  // namespace sinew
