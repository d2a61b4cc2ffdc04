#include "host_app/session/sync_proof.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "common/base/error.h"
#include "host_app/session/report/live_report.h"

namespace vantage {
namespace {

/// Age from which a measurement is doubtful: cables, cards and settings change.
constexpr int max_age_days = 30;
/// Largest skew between sensors: an object at 10 m/s moves 5 mm in it.
constexpr double max_skew_ms = 0.5;

bool has_strays(const SyncRecord& record) {
    return std::any_of(record.sensors.begin(), record.sensors.end(),
                       [](const SensorSkew& sensor) { return sensor.strays > 0; });
}

}  // namespace

SyncProof sync_proof_of(const std::filesystem::path& stage_file) {
    const std::filesystem::path file = sync_file_of(stage_file);
    std::error_code ignored;
    if (!std::filesystem::exists(file, ignored)) return {};
    try {
        return {load_sync(file), ""};
    } catch (const Error& error) {
        return {std::nullopt, error.what()};
    }
}

std::string sync_words(const SyncProof& proof, std::chrono::system_clock::time_point now) {
    if (!proof.fault.empty()) return "the measurement cannot be read: " + proof.fault;
    if (!proof.record) return "not measured (run vantage-calib sync)";
    const std::optional<int> days = days_since(proof.record->date, now);
    return fmt::format(
        "measured {}, {:.2f} ms{}", days ? fmt::format("{} d ago", *days) : "at an unknown time",
        proof.record->worst_ms(), has_strays(*proof.record) ? ", some frames at wrong pulses" : "");
}

bool is_doubtful(const SyncProof& proof, std::chrono::system_clock::time_point now) {
    if (!proof.record || has_strays(*proof.record)) return true;
    return proof.record->worst_ms() > max_skew_ms ||
           days_since(proof.record->date, now).value_or(max_age_days + 1) > max_age_days;
}

nlohmann::ordered_json to_json(const SyncProof& proof, std::chrono::system_clock::time_point now) {
    if (!proof.record) return nullptr;
    const SyncRecord& record = *proof.record;
    const auto furthest = std::max_element(record.sensors.begin(), record.sensors.end(),
                                           [](const SensorSkew& a, const SensorSkew& b) {
                                               return std::abs(a.skew_ms) < std::abs(b.skew_ms);
                                           });
    nlohmann::ordered_json json{{"date", record.date}};
    if (const std::optional<int> days = days_since(record.date, now)) json["age_days"] = *days;
    json["worst_ms"] = record.worst_ms();
    json["reference"] = record.reference;
    json["furthest"] = {{"sensor", furthest->name()},
                        {"skew_ms", furthest->skew_ms},
                        {"sigma_ms", furthest->sigma_ms}};
    json["doubtful"] = is_doubtful(proof, now);
    return json;
}

}  // namespace vantage
