// Scenes are read strictly: an unknown key, name or index is an error.
#include <nlohmann/json.hpp>
#include <support/oracle/scene_file.hpp>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <stdexcept>

namespace thalweg::oracle {

namespace {

using Json = nlohmann::json;

constexpr std::array<std::string_view, 5> kValidityNames{"valid", "flat", "occupied", "crossed",
                                                         "off-ground"};

void expect_keys(const Json& object, std::initializer_list<std::string_view> known) {
  for (const auto& [key, value] : object.items()) {
    if (std::find(known.begin(), known.end(), key) == known.end())
      throw std::runtime_error("unknown key " + key);
  }
}

// Sites are referred to by label.
int site_of(const SceneFile& file, const Json& label) {
  const auto at = std::find(file.labels.begin(), file.labels.end(), label.get<std::string>());
  if (at == file.labels.end()) throw std::runtime_error("unknown site " + label.dump());
  return static_cast<int>(at - file.labels.begin());
}

Edge edge_from(const SceneFile& file, const Json& pair) {
  if (pair.size() != 2) throw std::runtime_error("no edge: " + pair.dump());
  return edge_of(site_of(file, pair[0]), site_of(file, pair[1]));
}

Definition definition_named(const std::string& name) {
  for (const Definition d : kDefinitions) {
    if (name_of(d) == name) return d;
  }
  throw std::runtime_error("unknown definition " + name);
}

ExpectedTriangle triangle_from(const SceneFile& file, const Json& entry) {
  expect_keys(entry, {"corners", "why", "counted", "validity"});
  ExpectedTriangle triangle;
  triangle.why = entry.at("why").get<std::string>();
  for (std::size_t i = 0; i < 3; ++i) triangle.corners[i] = site_of(file, entry.at("corners").at(i));
  if (entry.contains("validity")) {
    const auto at =
        std::find(kValidityNames.begin(), kValidityNames.end(), entry["validity"].get<std::string>());
    if (at == kValidityNames.end()) throw std::runtime_error("unknown validity");
    triangle.validity = static_cast<Validity>(at - kValidityNames.begin());
    return triangle;
  }
  if (entry.at("counted").size() != kDefinitionCount)
    throw std::runtime_error("not all definitions are given");
  for (const auto& [name, sites] : entry.at("counted").items()) {
    SiteSet& counted = triangle.counted[static_cast<std::size_t>(definition_named(name))];
    for (const Json& site : sites) counted |= SiteSet{1} << site_of(file, site);
  }
  return triangle;
}

ExpectedEdge edge_expectation_from(const SceneFile& file, const Json& entry) {
  expect_keys(entry, {"edge", "why", "useful", "greedy"});
  ExpectedEdge expected{edge_from(file, entry.at("edge")), entry.at("why").get<std::string>(), {}, {}};
  for (const auto& [name, k] : entry.at("useful").items())
    expected.useful[definition_named(name)] = k.get<int>();
  for (const Json& corners : entry.value("greedy", Json::array())) {
    if (corners.size() != 3) throw std::runtime_error("no triangle: " + corners.dump());
    expected.greedy.push_back(
        {site_of(file, corners[0]), site_of(file, corners[1]), site_of(file, corners[2])});
  }
  return expected;
}

SceneFile parse(const Json& json) {
  expect_keys(json, {"about", "sites", "constraints", "boundary", "triangles", "edges"});
  SceneFile file;
  file.about = json.at("about").get<std::string>();
  for (const auto& site : json.at("sites")) {
    if (site.size() != 3) throw std::runtime_error("a site is [label, x, y]");
    file.labels.push_back(site[0].get<std::string>());
    file.scene.sites.push_back({site[1].get<std::int64_t>(), site[2].get<std::int64_t>()});
  }
  const auto edges = [&](const char* key) {
    std::vector<Edge> found;
    for (const Json& pair : json.value(key, Json::array())) found.push_back(edge_from(file, pair));
    return found;
  };
  file.scene.constraints = edges("constraints");
  file.scene.boundary = edges("boundary");
  for (const Edge& e : file.scene.boundary) {
    if (!file.scene.constrained(e.first, e.second)) file.scene.constraints.push_back(e);
  }
  const std::string wrong = defect(file.scene);
  if (!wrong.empty()) throw std::runtime_error(wrong);
  for (const Json& t : json.value("triangles", Json::array()))
    file.triangles.push_back(triangle_from(file, t));
  for (const Json& e : json.value("edges", Json::array()))
    file.edges.push_back(edge_expectation_from(file, e));
  return file;
}

}  // namespace

std::vector<std::string> scene_names(const std::string& folder) {
  std::vector<std::string> names;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".json") names.push_back(entry.path().stem().string());
  }
  std::sort(names.begin(), names.end());
  return names;
}

SceneFile read_scene(const std::string& folder, const std::string& name) {
  const std::string path = folder + "/" + name + ".json";
  try {
    std::ifstream stream(path);
    if (!stream) throw std::runtime_error("cannot be opened");
    SceneFile file = parse(Json::parse(stream));
    file.name = name;
    return file;
  } catch (const std::exception& e) {
    throw std::runtime_error(path + ": " + e.what());
  }
}

}  // namespace thalweg::oracle
