#include "crs_text.hpp"

#include <algorithm>
#include <array>
#include <cctype>
#include <optional>
#include <string_view>
#include <tuple>
#include <utility>

#include <priormap/core/error.hpp>

namespace priormap {
namespace {

std::string trimmed(const std::string& text) {
  const char* blank = " \t\r\n";
  const auto start = text.find_first_not_of(blank);
  return start == std::string::npos ? "" : text.substr(start, text.find_last_not_of(blank) - start + 1);
}

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string upper(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  return text;
}

bool is_number(std::string_view text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
}

/// "EPSG:n" where `text` is `prefix` (in any case) and a number.
std::optional<std::string> epsg_after(const std::string& text, const std::string& prefix) {
  if (!lower(text).starts_with(prefix)) return std::nullopt;
  const std::string code = text.substr(prefix.size());
  if (!is_number(code)) return std::nullopt;
  return "EPSG:" + code;
}

std::optional<std::string> legacy_gml_name(const std::string& text) {
  for (const char* prefix :
       {"http://www.opengis.net/gml/srs/epsg.xml#", "https://www.opengis.net/gml/srs/epsg.xml#", "urn:epsg:geographiccrs:",
        "urn:epsg:projectedcrs:", "urn:epsg:compoundcrs:", "urn:epsg:verticalcrs:", "epsg::", "+init=epsg:"})
    if (auto code = epsg_after(text, prefix)) return code;
  return std::nullopt;
}

/// "CRS:84" of WMS 1.3 (OGC 06-042, B.3), longitude first.
std::optional<std::string> wms_name(const std::string& text) {
  const std::string name = upper(text);
  return name == "CRS:84" || name == "CRS:83" || name == "CRS:27" ? std::optional("OGC:CRS" + name.substr(4)) : std::nullopt;
}

// Coordinate reference systems of GeoInfoDok (AdV), the German survey's exchange model, by their EPSG codes.
constexpr std::array<std::pair<std::string_view, std::string_view>, 16> adv_codes = {{
    {"ETRS89_Lat-Lon", "4258"},
    {"ETRS89_Lat-Lon-h", "4937"},
    {"DE_DHDN_3GK2", "31466"},
    {"DE_DHDN_3GK3", "31467"},
    {"DE_DHDN_3GK4", "31468"},
    {"DE_DHDN_3GK5", "31469"},
    {"DE_42-83_3GK3", "2397"},
    {"DE_42-83_3GK4", "2398"},
    {"DE_42-83_3GK5", "2399"},
    {"DE_RD-83_3GK4", "3398"},
    {"DE_RD-83_3GK5", "3399"},
    {"DE_DHHN2016_NH", "7837"},
    {"DE_DHHN92_NH", "5783"},
    {"DE_DHHN85_NOH", "5784"},
    {"DE_DHHN12_NOH", "7699"},
    {"DE_SNN76_NH", "5785"},
}};

std::string adv_code(const std::string& name) {
  const std::string utm = "ETRS89_UTM";
  if (name.starts_with(utm)) {
    const std::string zone = name.substr(utm.size());
    if (zone.size() == 2 && is_number(zone) && zone >= "28" && zone <= "38") return "258" + zone;
  }
  // Regional realisations of the Gauss-Krueger net ("DE_DHDN_3GK3_BW100") share its code.
  for (const auto& [known, code] : adv_codes)
    if (name == known || (known.starts_with("DE_DHDN") && name.starts_with(std::string(known) + "_"))) return std::string(code);
  throw CrsError("'" + name + "' is no coordinate reference system of GeoInfoDok that priormap knows; give its EPSG code");
}

std::string adv_name(const std::string& name) {
  const auto star = name.find('*');
  if (star == std::string::npos) return "EPSG:" + adv_code(name);
  return "EPSG:" + adv_code(name.substr(0, star)) + "+" + adv_code(name.substr(star + 1));
}

std::string proj_string(const std::string& text) {
  return text.find("type=crs") == std::string::npos ? text + " +type=crs" : text;
}

ProjObject registered(const ProjContext& context, const std::string& authority, const std::string& code) {
  return ProjObject(proj_create_from_database(context, authority.c_str(), code.c_str(), PJ_CATEGORY_CRS, 0, nullptr));
}

ProjObject compound(const ProjContext& context, const ProjObject& horizontal, const ProjObject& vertical) {
  if (!horizontal || !vertical) return nullptr;
  const std::string name = std::string(proj_get_name(horizontal.get())) + " + " + proj_get_name(vertical.get());
  return ProjObject(proj_create_compound_crs(context, name.c_str(), horizontal.get(), vertical.get()));
}

/// "AUTHORITY:code", "AUTHORITY:code+code" or "AUTHORITY:code+AUTHORITY:code".
struct RegistryName {
  std::string authority, code, vertical_authority, vertical_code;
};

std::pair<std::string, std::string> split(const std::string& text, char separator) {
  const auto place = text.find(separator);
  if (place == std::string::npos) return {text, ""};
  return {text.substr(0, place), text.substr(place + 1)};
}

bool is_word(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '-'; });
}

std::optional<RegistryName> registry_name(const std::string& text) {
  const auto [horizontal, vertical] = split(text, '+');
  const auto [authority, code] = split(horizontal, ':');
  RegistryName name{upper(authority), code, upper(authority), vertical};
  if (vertical.find(':') != std::string::npos) std::tie(name.vertical_authority, name.vertical_code) = split(vertical, ':');
  const bool compound_complete = text.find('+') == std::string::npos || (is_word(name.vertical_authority) && is_word(name.vertical_code));
  if (!is_word(name.authority) || !is_word(name.code) || !compound_complete) return std::nullopt;
  return name;
}

}  // namespace

std::string proj_definition(const std::string& given) {
  const std::string text = trimmed(given);
  if (text.empty()) throw CrsError("no coordinate reference system is given; give one such as EPSG:25832+7837");
  const std::string adv = "urn:adv:crs:";
  if (lower(text).starts_with(adv)) return adv_name(text.substr(adv.size()));
  if (const auto ogc = wms_name(text)) return *ogc;
  const std::string older = "urn:x-ogc:";
  if (lower(text).starts_with(older)) return "urn:ogc:" + text.substr(older.size());
  if (auto code = legacy_gml_name(text)) return *code;
  if (text.starts_with('+')) return proj_string(text);
  if (text.starts_with('{') || text.find('[') != std::string::npos) return text;
  const std::string start = lower(text);
  if (start.starts_with("urn:") || start.starts_with("http://") || start.starts_with("https://")) return text;
  if (registry_name(text)) return text;
  throw CrsError("'" + text.substr(0, 80) + "' is no code of a coordinate reference system; give one such as EPSG:25832+7837, WKT, " +
                 "PROJJSON or a PROJ string");
}

ProjObject create_crs(const ProjContext& context, const std::string& definition) {
  const auto name = registry_name(definition);
  if (!name) return ProjObject(proj_create(context, definition.c_str()));
  ProjObject horizontal = registered(context, name->authority, name->code);
  if (name->vertical_code.empty()) return horizontal;
  return compound(context, horizontal, registered(context, name->vertical_authority, name->vertical_code));
}

}  // namespace priormap
