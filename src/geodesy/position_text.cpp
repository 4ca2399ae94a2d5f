// Positions in text are brought to the form that GeographicLib::GeoCoords reads: one word is MGRS, two are
// longitude and latitude, three are UTM.
#include <thalweg/base/error.hpp>
#include <thalweg/geodesy/position_text.hpp>

#include <GeographicLib/GeoCoords.hpp>
#include <GeographicLib/UTMUPS.hpp>

#include <algorithm>
#include <cctype>
#include <exception>

namespace thalweg {

namespace {

bool is_digit(char c) {
  return std::isdigit(static_cast<unsigned char>(c)) != 0;
}
bool is_blank(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

std::string without_blanks(std::string_view text, PositionForm form) {
  std::string packed;
  bool gap = false;
  for (const char c : text) {
    if (is_blank(c)) {
      gap = true;
      continue;
    }
    const bool parts = gap && !packed.empty() && is_digit(packed.back()) && is_digit(c);
    if (parts && form == PositionForm::Dms) packed += ':';
    gap = false;
    if (c == '"' && !packed.empty() && packed.back() == '"') continue;  // doubled within quotes
    packed += c;
  }
  return packed;
}

std::string joined(std::span<const std::string_view> fields, PositionForm form) {
  std::string text;
  for (const std::string_view field : fields) {
    if (!text.empty()) text += ' ';
    text += form == PositionForm::Utm ? std::string(field) : without_blanks(field, form);
  }
  return text;
}

std::ptrdiff_t count_words(const std::string& text) {
  std::ptrdiff_t words = 0;
  for (std::size_t i = 0; i < text.size(); ++i)
    words += !is_blank(text[i]) && (i == 0 || is_blank(text[i - 1]));
  return words;
}

[[noreturn]] void refuse(const std::string& text, const std::string& why) {
  throw Error(ErrorCode::BadCoordinate, "\"" + text + "\" is no position: " + why);
}

// GeographicLib's decoder writes beyond its three parts where a colon follows the third.
void check_parts(const std::string& text) {
  constexpr std::string_view kBesideColons = "0123456789.:+-NSEWnsewdD*\xc2\xb0\xba";  // degree signs too
  for (std::size_t begin = 0; begin < text.size();) {
    const std::size_t end = std::min(text.find(' ', begin), text.size());
    const std::string_view word = std::string_view(text).substr(begin, end - begin);
    begin = end + 1;
    if (word.find(':') == std::string_view::npos) continue;
    if (word.find_first_not_of(kBesideColons) != std::string_view::npos) {
      refuse(text, "minutes and seconds are parted by colons, or have marks of their own, not both");
    }
    std::size_t colons = 0;
    for (const char c : word) {
      colons = c == '+' || c == '-' ? 0 : colons + (c == ':' ? 1 : 0);
      if (colons > 2) refuse(text, "nothing is finer than seconds");
    }
  }
}

void check_form(const std::string& text, PositionForm form) {
  constexpr std::ptrdiff_t kUtmWords = 3;
  switch (form) {
    case PositionForm::Dms:
      if (count_words(text) != 2) refuse(text, "a longitude and a latitude are needed");
      return;
    case PositionForm::Utm:
      if (count_words(text) != kUtmWords) {
        refuse(text, "zone and hemisphere, easting and northing are needed, as 32N 676000 5148000");
      }
      return;
    case PositionForm::Mgrs:
      if (count_words(text) != 1 || text.size() < 2 || !is_digit(text.back()) ||
          !is_digit(text[text.size() - 2])) {
        refuse(text, "a square of 10 km or less is needed, as 32TPT7612345678");
      }
      return;
  }
}

}  // namespace

Point2 parse_position(std::span<const std::string_view> fields, PositionForm form) {
  const std::string text = joined(fields, form);
  check_form(text, form);
  check_parts(text);
  try {
    constexpr bool kCentreOfSquare = true, kLongitudeFirst = true;
    const GeographicLib::GeoCoords position(text, kCentreOfSquare, kLongitudeFirst);
    const Point2 lonlat = {position.Longitude(), position.Latitude()};
    if (!std::isfinite(lonlat.x) || !std::isfinite(lonlat.y)) refuse(text, "it is not finite");
    if (std::abs(lonlat.x) > 360) refuse(text, "its longitude is beyond 360 degrees");
    return lonlat;
  } catch (const Error&) {
    throw;
  } catch (const std::exception& error) {
    refuse(text, error.what());
  }
}

int utm_or_ups_epsg(Point2 lonlat_deg) {
  using GeographicLib::UTMUPS;
  if (!(std::abs(lonlat_deg.y) <= 90)) {
    throw Error(ErrorCode::BadCoordinate, "latitude " + std::to_string(lonlat_deg.y) + " is out of range");
  }
  const bool north = lonlat_deg.y >= 0;
  const int zone = UTMUPS::StandardZone(lonlat_deg.y, lonlat_deg.x);
  if (zone == UTMUPS::UPS) return north ? 5041 : 5042;
  return (north ? 32600 : 32700) + zone;
}

}  // namespace thalweg
