// LandXML 1.2: one TIN surface, as civil engineering programs read it.
//
// Positions are "northing easting elevation". Constraint edges are breaklines of the surface's source data,
// with their kind as description. The file's date is fixed, so that equal input gives equal bytes.
#include "io/file_writer.hpp"
#include "io/write_steps.hpp"

#include <thalweg/io/crs.hpp>

#include <filesystem>
#include <string>
#include <string_view>

namespace thalweg {

namespace {

std::string escaped(std::string_view text) {
  std::string result;
  for (const char c : text) {
    if (c == '&') {
      result += "&amp;";
    } else if (c == '<') {
      result += "&lt;";
    } else if (c == '>') {
      result += "&gt;";
    } else if (c == '"') {
      result += "&quot;";
    } else {
      result += c;
    }
  }
  return result;
}

constexpr double kFoot = 0.3048, kSurveyFoot = 1200.0 / 3937;

// LandXML knows metres and the two feet; what else there is stands in the CRS.
std::string units(const CrsInfo& crs) {
  const bool feet = !crs.geographic && is_same_unit(crs.horizontal_metres_per_unit, kFoot);
  const bool survey_feet = !crs.geographic && is_same_unit(crs.horizontal_metres_per_unit, kSurveyFoot);
  const bool feet_high = is_same_unit(crs.vertical_metres_per_unit, kFoot) ||
                         is_same_unit(crs.vertical_metres_per_unit, kSurveyFoot);
  const std::string elevation = std::string(" elevationUnit=\"") + (feet_high ? "feet" : "meter") + "\"";
  if (feet || survey_feet) {
    return "<Imperial areaUnit=\"squareFoot\" linearUnit=\"" + std::string(feet ? "foot" : "USSurveyFoot") +
           "\" volumeUnit=\"cubicYard\" temperatureUnit=\"fahrenheit\" pressureUnit=\"inHG\"" + elevation +
           "/>";
  }
  return "<Metric areaUnit=\"squareMeter\" linearUnit=\"meter\" volumeUnit=\"cubicMeter\" "
         "temperatureUnit=\"celsius\" pressureUnit=\"milliBars\"" +
         elevation + "/>";
}

std::string coordinate_system(const CrsInfo& crs) {
  if (!crs.known) return {};
  std::string text = "  <CoordinateSystem name=\"" + escaped(crs.name) + "\"";
  if (crs.authority.rfind("EPSG:", 0) == 0) text += " epsgCode=\"" + escaped(crs.authority.substr(5)) + "\"";
  return text + " ogcWktCode=\"" + escaped(crs.wkt) + "\"/>\n";
}

void write_position(FileWriter& file, const TinWriteJob& job, std::size_t v) {
  file.number(job.xy()[v].y);
  file.character(' ');
  file.number(job.xy()[v].x);
  file.character(' ');
  file.number(job.view.tin.heights()[v]);
}

void write_breaklines(FileWriter& file, const TinWriteJob& job) {
  const std::vector<EdgeChain> chains = chains_to_write(job);
  if (chains.empty()) return;
  file.text("      <SourceData>\n        <Breaklines>\n");
  for (const EdgeChain& chain : chains) {
    file.text("          <Breakline brkType=\"standard\" desc=\"" + kind_words(chain.kind) +
              "\"><PntList3D>");
    for (std::size_t i = 0; i < chain.vertices.size(); ++i) {
      if (i > 0) file.character(' ');
      write_position(file, job, chain.vertices[i].index());
    }
    file.text("</PntList3D></Breakline>\n");
  }
  file.text("        </Breaklines>\n      </SourceData>\n");
}

}  // namespace

void write_landxml(const TinWriteJob& job) {
  const Tin& tin = job.view.tin;
  const std::string& definition = job.view.crs_wkt.empty() ? job.view.crs_authority : job.view.crs_wkt;
  const CrsInfo crs = describe_crs(definition);
  const std::string name = escaped(std::filesystem::path(job.target).stem().string());
  FileWriter file(job.path, job.target);
  file.text(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
      "<LandXML xmlns=\"http://www.landxml.org/schema/LandXML-1.2\" "
      "xmlns:xsi=\"http://www.w3.org/2001/XMLSchema-instance\" "
      "xsi:schemaLocation=\"http://www.landxml.org/schema/LandXML-1.2 "
      "http://www.landxml.org/schema/LandXML-1.2/LandXML-1.2.xsd\" version=\"1.2\" date=\"2000-01-01\" "
      "time=\"00:00:00\">\n  <Units>" +
      units(crs) + "</Units>\n" + coordinate_system(crs) +
      "  <Application name=\"Thalweg\"/>\n  <Surfaces>\n    <Surface name=\"" + name + "\">\n");
  write_breaklines(file, job);
  file.text("      <Definition surfType=\"TIN\">\n        <Pnts>\n");
  write_each(job, 0, tin.vertex_count(), [&](std::size_t v) {
    file.text("<P id=\"");
    file.number(v + 1);
    file.text("\">");
    write_position(file, job, v);
    file.text("</P>\n");
  });
  file.text("        </Pnts>\n        <Faces>\n");
  write_each(job, tin.vertex_count(), tin.triangle_count(), [&](std::size_t t) {
    file.text("<F>");
    for (std::size_t i = 0; i < 3; ++i) {
      if (i > 0) file.character(' ');
      file.number(tin.triangles()[t][i].value() + 1);
    }
    file.text("</F>\n");
  });
  file.text("        </Faces>\n      </Definition>\n    </Surface>\n  </Surfaces>\n</LandXML>\n");
  file.close();
}

}  // namespace thalweg
