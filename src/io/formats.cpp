// The table of TIN formats, and the checks of creation options against it.
#include "base/lower_case.hpp"
#include "io/tin_format.hpp"

#include <thalweg/base/error.hpp>

#include <algorithm>
#include <array>
#include <cctype>
#include <filesystem>

namespace thalweg {

namespace {

bool same_word(std::string_view a, std::string_view b) {
  return lower(a) == lower(b);
}

std::string_view key_of(std::string_view pair) {
  return pair.substr(0, pair.find('='));
}
std::string_view values_of(std::string_view pair) {
  return pair.substr(pair.find('=') + 1);
}

std::vector<std::string> split(std::string_view text, char separator) {
  std::vector<std::string> words;
  while (true) {
    const std::size_t end = text.find(separator);
    words.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return words;
    text.remove_prefix(end + 1);
  }
}

std::string list_options(const FormatInfo& format) {
  std::string known;
  for (const std::string& option : format.creation_options) known += (known.empty() ? "" : ", ") + option;
  return known.empty() ? "it has none" : "known are " + known;
}

bool starts_with(std::string_view text, std::string_view start) {
  return text.substr(0, start.size()) == start;
}

bool recognises_ply(std::string_view head, const std::string&) {
  return starts_with(head, "ply\n") || starts_with(head, "ply\r");
}

bool recognises_2dm(std::string_view head, const std::string&) {
  return starts_with(head, "MESH2D");
}

bool recognises_gpkg(std::string_view head, const std::string&) {
  return starts_with(head, std::string_view("SQLite format 3\0", 16));
}

bool recognises_netcdf(std::string_view head, const std::string&) {
  return starts_with(head, "CDF") || starts_with(head, "\x89HDF");
}

bool recognises_landxml(std::string_view head, const std::string&) {
  for (std::size_t at = head.find('<'); at != std::string_view::npos; at = head.find('<', at + 1)) {
    std::string_view name = head.substr(at + 1);
    name = name.substr(0, name.find_first_of(" \t\r\n>"));
    if (name == "LandXML" || name.ends_with(":LandXML")) return true;
  }
  return false;
}

bool recognises_off(std::string_view head, const std::string&) {
  return starts_with(head, "OFF") &&
         (head.size() == 3 || std::isspace(static_cast<unsigned char>(head[3])) != 0);
}

// OBJ and binary STL have no signature.
bool recognises_obj(std::string_view, const std::string& path) {
  return extension_of(path) == ".obj";
}

bool recognises_stl(std::string_view, const std::string& path) {
  return extension_of(path) == ".stl";
}

using Crs = TinFormat::Crs;
using Numbers = TinFormat::Numbers;
using Target = TinFormat::Target;

std::vector<TinFormat> mesh_formats() {
  const std::vector<std::string> edges = {"EDGES=YES|NO"};
  return {
      {{"PLY", "Polygon file format (binary)", {".ply"}, true, true, edges},
       Crs::InFile,
       Numbers::Double,
       Target::Stream,
       write_ply,
       recognises_ply,
       read_ply},
      {{"2DM", "SMS mesh", {".2dm"}, true, true, edges},
       Crs::InSidecar,
       Numbers::Double,
       Target::Stream,
       write_2dm,
       recognises_2dm,
       read_2dm},
      {{"UGRID", "UGRID mesh in NetCDF", {".nc"}, true, true, edges},
       Crs::InFile,
       Numbers::Double,
       Target::File,
       write_ugrid,
       recognises_netcdf,
       read_ugrid},
      {{"LandXML", "LandXML 1.2 surface", {".xml", ".landxml"}, true, true, edges},
       Crs::InFile,
       Numbers::Double,
       Target::Stream,
       write_landxml,
       recognises_landxml,
       read_landxml},
  };
}

std::vector<TinFormat> model_formats() {
  const std::vector<std::string> edges = {"EDGES=YES|NO"};
  return {
      {{"OBJ", "Wavefront object", {".obj"}, true, true, edges},
       Crs::InSidecar,
       Numbers::Double,
       Target::Stream,
       write_obj,
       recognises_obj,
       read_obj},
      {{"OFF", "Object file format", {".off"}, true, true, {}},
       Crs::InSidecar,
       Numbers::Double,
       Target::Stream,
       write_off,
       recognises_off,
       read_off},
      {{"STL", "Stereolithography (binary), single precision", {".stl"}, true, true, {}},
       Crs::InSidecar,
       Numbers::Single,
       Target::Stream,
       write_stl,
       recognises_stl,
       read_stl},
      {{"GLB", "glTF 2.0 (binary), single precision", {".glb"}, false, true, edges},
       Crs::InSidecar,
       Numbers::SingleYUp,
       Target::Stream,
       write_glb,
       nullptr,
       nullptr},
      {{"VTU", "VTK unstructured grid", {".vtu"}, false, true, edges},
       Crs::InSidecar,
       Numbers::Double,
       Target::Stream,
       write_vtu,
       nullptr,
       nullptr},
  };
}

std::vector<TinFormat> vector_formats() {
  const std::vector<std::string> one_layer = {"LAYER=triangles|edges|vertices|breaklines|conflicts"};
  return {
      {{"GPKG",
        "GeoPackage layers",
        {".gpkg"},
        true,
        true,
        {"LAYERS=triangles,edges,vertices,breaklines,conflicts", "SPATIAL_INDEX=YES|NO"}},
       Crs::InFile,
       Numbers::Double,
       Target::File,
       write_gpkg,
       recognises_gpkg,
       read_gpkg_tin},
      {{"FlatGeobuf", "one layer", {".fgb"}, false, true, one_layer},
       Crs::InFile,
       Numbers::Double,
       Target::Stream,
       write_flatgeobuf,
       nullptr,
       nullptr},
      {{"Shapefile", "one layer, ESRI Shapefile", {".shp"}, false, true, one_layer},
       Crs::InFile,
       Numbers::Double,
       Target::File,
       write_shapefile,
       nullptr,
       nullptr},
      {{"GeoJSON", "one layer", {".geojson", ".json"}, false, true, one_layer},
       Crs::InFile,
       Numbers::Double,
       Target::Stream,
       write_geojson,
       nullptr,
       nullptr},
  };
}

}  // namespace

void refuse_repeated_keys(const std::vector<std::string>& pairs) {
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (!same_word(key_of(pairs[i]), key_of(pairs[j]))) continue;
      throw Error(ErrorCode::Usage, "--co gives " + std::string(key_of(pairs[i])) + " twice, as '" +
                                        pairs[j] + "' and '" + pairs[i] + "'; give it once");
    }
  }
}

CreationOptions::CreationOptions(const std::vector<std::string>& pairs, const FormatInfo& format) {
  for (const std::string& option : format.creation_options) {
    options_.push_back({std::string(key_of(option)), std::string(values_of(option))});
    // The default of a choice is its first value, that of a list the whole list.
    options_.back().value = split(options_.back().value, '|').front();
  }
  refuse_repeated_keys(pairs);
  for (const std::string& pair : pairs) {
    const auto known = std::find_if(options_.begin(), options_.end(), [&](const Option& option) {
      return same_word(option.key, key_of(pair));
    });
    if (pair.find('=') == std::string::npos || known == options_.end()) {
      throw Error(ErrorCode::Usage, "'" + pair + "' is no creation option of " + format.name + "; " +
                                        list_options(format) + " (--co KEY=VALUE)");
    }
    known->value = values_of(pair);
    const std::string& offered = format.creation_options[static_cast<std::size_t>(known - options_.begin())];
    const bool choice = offered.find('|') != std::string::npos;
    const std::vector<std::string> all = split(values_of(offered), choice ? '|' : ',');
    for (const std::string& word : split(known->value, choice ? '|' : ',')) {
      const auto same = [&](const std::string& value) { return same_word(value, word); };
      if (std::none_of(all.begin(), all.end(), same)) {
        throw Error(ErrorCode::Usage, "'" + word + "' is no value of the creation option " + known->key +
                                          " of " + format.name + "; " + list_options(format));
      }
    }
  }
}

const std::string& CreationOptions::value(std::string_view key) const {
  return std::find_if(options_.begin(), options_.end(), [&](const Option& o) { return o.key == key; })->value;
}

bool CreationOptions::enabled(std::string_view key) const {
  return same_word(value(key), "YES");
}

std::vector<std::string> CreationOptions::list(std::string_view key) const {
  return split(lower(value(key)), ',');
}

std::span<const TinFormat> tin_format_table() {
  static const std::vector<TinFormat> table = [] {
    std::vector<TinFormat> all = mesh_formats();
    for (const auto& more : {model_formats(), vector_formats()}) {
      all.insert(all.end(), more.begin(), more.end());
    }
    return all;
  }();
  return table;
}

std::span<const FormatInfo> tin_formats() {
  static const std::vector<FormatInfo> infos = [] {
    std::vector<FormatInfo> list;
    for (const TinFormat& format : tin_format_table()) list.push_back(format.info);
    return list;
  }();
  return infos;
}

std::string sidecar_path(const std::string& path) {
  return std::filesystem::path(path).replace_extension(".prj").string();
}

}  // namespace thalweg
