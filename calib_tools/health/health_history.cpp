#include "calib_tools/health/health_history.h"

#include <span>
#include <sstream>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {
namespace {

constexpr int line_version = 1;
constexpr std::size_t max_file_bytes = 16 << 20, max_checks = 1000;

PastCheck parse_line(const std::string& line) {
    const nlohmann::json json = nlohmann::json::parse(line);
    if (json.at("version") != line_version) fail("it is of another version");
    PastCheck check;
    check.date = json.at("date").get<std::string>();
    for (const nlohmann::json& m : json.at("measures"))
        check.values.push_back({m.at("what").get<std::string>(), m.at("rigs").get<std::string>(),
                                m.at("verdict").get<std::string>(), m.at("value").get<double>()});
    return check;
}

std::string to_line(const PastCheck& check) {
    nlohmann::json measures = nlohmann::json::array();
    for (const PastCheck::Value& v : check.values)
        measures.push_back(
            {{"what", v.what}, {"rigs", v.rigs}, {"verdict", v.verdict}, {"value", v.value}});
    const nlohmann::json json = {
        {"version", line_version}, {"date", check.date}, {"measures", measures}};
    return json.dump() + "\n";
}

}  // namespace

std::vector<PastCheck> load_history(const std::filesystem::path& path) {
    std::vector<PastCheck> past;
    if (!std::filesystem::exists(path)) return past;
    const std::vector<std::byte> bytes = read_file(path, max_file_bytes);
    std::istringstream lines(
        std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    std::string line;
    for (int number = 1; std::getline(lines, line); ++number) {
        if (line.empty()) continue;
        try {
            past.push_back(parse_line(line));
        } catch (const std::exception& error) {
            fail("{}:{}: this is no line of a check's history ({}); mend it or begin a new file",
                 path.string(), number, error.what());
        }
    }
    return past;
}

void append_history(const std::filesystem::path& path, std::vector<PastCheck> past,
                    const PastCheck& present) {
    past.push_back(present);
    const std::size_t first = past.size() > max_checks ? past.size() - max_checks : 0;
    std::string text;
    for (std::size_t i = first; i < past.size(); ++i) text += to_line(past[i]);
    write_file_atomically(path, std::as_bytes(std::span(text)));
}

PastCheck past_check(const StageHealth& health, const std::string& date) {
    PastCheck check{date, {}};
    for (const HealthMeasure& m : health.measures)
        if (m.verdict != Verdict::unknown)
            check.values.push_back({m.what, m.rigs, std::string(verdict_name(m.verdict)), m.value});
    return check;
}

std::vector<double> values_of(const std::vector<PastCheck>& past, const HealthMeasure& measure) {
    std::vector<double> values;
    for (const PastCheck& check : past)
        for (const PastCheck::Value& v : check.values)
            if (v.what == measure.what && v.rigs == measure.rigs) values.push_back(v.value);
    return values;
}

}  // namespace vantage
