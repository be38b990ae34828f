#include <algorithm>
#include <bit>

#include "engine/io/text_patch.h"
#include "engine/io/values.h"
#include "engine/io/vtk_array.h"
#include "engine/io/vtp.h"

namespace sinew::io {

namespace {

const char* xml_name(Type type) {
  static constexpr const char* names[] = {"Int8",   "UInt8", "Int16",  "UInt16",  "Int32",
                                          "UInt32", "Int64", "UInt64", "Float32", "Float64"};
  return names[static_cast<int>(type)];
}

std::string escaped(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else if (static_cast<unsigned char>(c) < ' ')
      out += "_";
    else
      out += c;
  }
  return out;
}

/// A new file: the elements, and the data that are appended.
class NewVtp {
 public:
  NewVtp(const Shape& shape, bool grid, WriteReport& report) : shape_(shape), grid_(grid), report_(report) {}

  std::vector<std::byte> bytes() {
    const std::string kind = grid_ ? "UnstructuredGrid" : "PolyData";
    const std::size_t faces = shape_.faces.size(), n = shape_.size(), cells = faces + shape_.tets.size();
    text_ = "<?xml version=\"1.0\"?>\n<VTKFile type=\"" + kind +
            "\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n  <" + kind +
            ">\n    <Piece NumberOfPoints=\"" + std::to_string(n) + "\"";
    if (grid_) {
      text_ += " NumberOfCells=\"" + std::to_string(cells == 0 ? n : cells) + "\">\n";
    } else {
      text_ += " NumberOfVerts=\"" + std::to_string(faces == 0 ? n : 0) +
               "\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"" + std::to_string(faces) + "\">\n";
    }
    text_ += "      <PointData>\n";
    for (const Attribute& a : new_vtk_attributes(shape_, grid_ ? "VTU" : "VTP", report_))
      add(a.name, a.type, static_cast<std::size_t>(a.components), a.values);
    text_ += "      </PointData>\n      <Points>\n";
    add("Points", shape_.position_type, 3, new_vtk_points(shape_, report_));
    text_ += "      </Points>\n";
    add_cells();
    text_ += "    </Piece>\n  </" + kind + ">\n  <AppendedData encoding=\"raw\">\n_";
    std::vector<std::byte> out;
    append_text(out, text_);
    out.insert(out.end(), data_.begin(), data_.end());
    append_text(out, "\n  </AppendedData>\n</VTKFile>\n");
    return out;
  }

 private:
  static constexpr bool swap = std::endian::native != std::endian::little;

  void add(const std::string& name, Type type, std::size_t components, std::span<const std::byte> values) {
    text_ += std::string("        <DataArray type=\"") + xml_name(type) + "\" Name=\"" + escaped(name) +
             "\" NumberOfComponents=\"" + std::to_string(components) + "\" format=\"appended\" offset=\"" +
             std::to_string(data_.size()) + "\"/>\n";
    std::byte length[8];
    store(length, static_cast<std::uint64_t>(values.size()), swap);
    data_.insert(data_.end(), length, length + sizeof(length));
    const std::size_t begin = data_.size(), size = size_of(type);
    data_.insert(data_.end(), values.begin(), values.end());
    if constexpr (swap)
      for (std::size_t i = begin; i < data_.size(); i += size) std::reverse(&data_[i], &data_[i] + size);
  }

  void add(const std::string& name, const std::vector<std::int64_t>& numbers) {
    add(name, Type::Int64, 1, std::as_bytes(std::span(numbers)));
  }

  void add_cells() {
    std::vector<std::int64_t> corners, ends;
    const bool tets = grid_ && !shape_.tets.empty(), vertices = shape_.faces.empty() && !tets;
    std::vector<std::byte> types;
    if (vertices) {
      for (std::size_t i = 0; i < shape_.size(); ++i) {
        corners.push_back(static_cast<std::int64_t>(i));
        ends.push_back(static_cast<std::int64_t>(i + 1));
      }
    } else {
      corners.assign(shape_.faces.points.begin(), shape_.faces.points.end());
      ends.assign(shape_.faces.offsets.begin() + 1, shape_.faces.offsets.end());
    }
    types.resize(ends.size(), static_cast<std::byte>(vertices ? vtk_vertex : vtk_polygon));
    for (std::size_t t = 0; tets && t < shape_.tets.size(); ++t) {
      corners.insert(corners.end(), shape_.tets[t].begin(), shape_.tets[t].end());
      ends.push_back(static_cast<std::int64_t>(corners.size()));
      types.push_back(static_cast<std::byte>(vtk_tetra));
    }
    const std::string section = grid_ ? "Cells" : vertices ? "Verts" : "Polys";
    text_ += "      <" + section + ">\n";
    add("connectivity", corners);
    add("offsets", ends);
    if (grid_) add("types", Type::UInt8, 1, types);
    text_ += "      </" + section + ">\n";
  }

  const Shape& shape_;
  bool grid_;
  WriteReport& report_;
  std::string text_;
  std::vector<std::byte> data_;
};

std::vector<std::byte> write(const Shape& shape, VtkContent::Form form, WriteReport& report) {
  const auto* content = dynamic_cast<const VtkContent*>(shape.content.get());
  if (content && fits_vtk(shape, *content, form)) return patched_vtk(shape, *content, report);
  if (content && content->form == form)
    report.lost.push_back(
        "What the VTK file held besides points, data of points, polygons and tets is not written: the "
        "points, attributes, faces or tets are no longer those of the file.");
  return NewVtp(shape, form == VtkContent::Form::UnstructuredGrid, report).bytes();
}

}  // namespace

std::vector<std::byte> write_vtp(const std::string&, const Shape& shape, WriteReport& report) {
  return write(shape, VtkContent::Form::PolyData, report);
}

std::vector<std::byte> write_vtu(const std::string&, const Shape& shape, WriteReport& report) {
  return write(shape, VtkContent::Form::UnstructuredGrid, report);
}

}  // namespace sinew::io
