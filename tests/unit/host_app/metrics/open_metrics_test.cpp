#include "host_app/metrics/open_metrics.h"

#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "tests/support/source_folder.h"

namespace vantage {
namespace {

LiveReport example() {
    LiveReport report;
    report.synthesiser = "fused";
    report.renderer = "llvm\"pipe\\";
    report.rate_hz = 25;
    report.programme.ticks = 1'234'567;
    report.programme.missed = 89;
    report.programme.latency_ms = {.count = 7, .p50 = 84, .p95 = 90, .p99 = 99, .max = 120};
    report.programme.interval_ms = report.programme.input_ms = report.programme.seek_ms =
        report.programme.latency_ms;
    report.programme.render_ms = report.programme.latency_ms;
    report.programme.render_shares = {0.75, 0.25};
    report.corridor.now = Coverage{.share = 0.5};
    RigAccount rig;
    rig.status.rig = "north";
    rig.status.connected = true;
    rig.status.received = 99;
    rig.status.latency_ms = report.programme.latency_ms;
    rig.status.health.temperature_c = 61.5f;
    rig.status.health.refused_connections = 900;
    rig.background.emplace();
    report.rigs = {rig};
    OutputState output;
    output.name = "srt://0.0.0.0:9000";
    output.phase = OutputPhase::on;
    report.outputs = {output};
    report.take.emplace();
    PortState port;
    port.name = "osc://:9000";
    port.stats.obeyed = 3;
    port.stats.malformed = 1;
    report.ports = {port};
    return report;
}

std::vector<std::string> lines_of(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

TEST(OpenMetrics, AreWellFormed) {
    const std::vector<std::string> lines = lines_of(to_open_metrics(example()));
    const std::regex type("# TYPE (vantage_[a-z_]+) (gauge|counter|summary|info)");
    const std::regex help("# HELP (vantage_[a-z_]+) [^\n]+");
    const std::regex sample(
        "(vantage_[a-z_]+)(\\{([a-z]+=\"([^\"\\\\]|\\\\.)*\",?)+\\})? (-?[0-9.e+-]+)");
    const std::map<std::string, std::set<std::string>> endings{
        {"gauge", {""}}, {"counter", {"_total"}}, {"summary", {"", "_count"}}, {"info", {"_info"}}};
    std::set<std::string> families, samples;
    std::string family, kind;
    for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
        std::smatch match;
        if (std::regex_match(lines[i], match, type)) {
            family = match[1];
            kind = match[2];
            EXPECT_TRUE(families.insert(family).second) << family << " is there twice";
            continue;
        }
        if (std::regex_match(lines[i], match, help)) {
            EXPECT_EQ(match[1], family);
            continue;
        }
        ASSERT_TRUE(std::regex_match(lines[i], match, sample)) << lines[i];
        ASSERT_TRUE(match[1].str().starts_with(family)) << lines[i] << " is of no family";
        EXPECT_TRUE(endings.at(kind).contains(match[1].str().substr(family.size()))) << lines[i];
        EXPECT_TRUE(samples.insert(lines[i].substr(0, lines[i].rfind(' '))).second) << lines[i];
    }
    EXPECT_EQ(lines.back(), "# EOF");
}

TEST(OpenMetrics, ContainTheReportsValues) {
    const std::string text = to_open_metrics(example());
    for (const char* line :
         {"vantage_ticks_total 1234567\n", "vantage_missed_ticks_total 89\n",
          "vantage_exposure_to_picture_seconds{quantile=\"0.5\"} 0.084\n",
          "vantage_exposure_to_picture_seconds_count 7\n", "vantage_coverage_ratio 0.5\n",
          "vantage_rig_frames_total{rig=\"north\",place=\"host\",result=\"received\"} 99\n",
          "vantage_rig_temperature_celsius{rig=\"north\"} 61.5\n",
          "vantage_rig_refused_connections_total{rig=\"north\"} 900\n",
          "vantage_output_up{output=\"srt://0.0.0.0:9000\"} 1\n",
          "vantage_control_messages_total{port=\"osc://:9000\",result=\"malformed\"} 1\n",
          "renderer=\"llvm\\\"pipe\\\\\""})
        EXPECT_NE(text.find(line), std::string::npos) << line << text;
}

TEST(OpenMetrics, ContainTheDashboardsMetrics) {
    std::ifstream file(source_folder() / "hw_config/grafana/vantage.json");
    const nlohmann::json dashboard = nlohmann::json::parse(file);
    const std::string text = to_open_metrics(example());
    const std::regex name("vantage_[a-z_]+");
    int asked = 0;
    for (const nlohmann::json& panel : dashboard["panels"])
        for (const nlohmann::json& target : panel["targets"]) {
            const std::string expression = target["expr"];
            for (std::sregex_iterator at(expression.begin(), expression.end(), name), end;
                 at != end; ++at) {
                ++asked;
                EXPECT_TRUE(text.find("\n" + at->str() + "{") != std::string::npos ||
                            text.find("\n" + at->str() + " ") != std::string::npos)
                    << at->str();
            }
        }
    EXPECT_GT(asked, 10);
}

}  // namespace
}  // namespace vantage
