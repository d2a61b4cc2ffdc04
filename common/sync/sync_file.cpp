#include "common/sync/sync_file.h"

#include <algorithm>

#include <opencv2/core.hpp>

#include "common/config/yaml/number_checksum.h"
#include "common/config/yaml/yaml_section.h"

namespace vantage {
namespace {

constexpr YamlKind file_kind{"vantage synchronisation", "a proof of synchronisation", 1};
constexpr const char* file_units =
    "milliseconds, hertz; skews are of the centres of exposures, positive: later than the "
    "reference";
constexpr std::size_t most_sensors = 1000;

std::string checksum_of(const SyncRecord& record) {
    NumberChecksum hash;
    hash.add(record.reference);
    hash.add(record.rate_hz);
    hash.add(record.bar_step_ms);
    for (const SensorSkew& s : record.sensors) {
        hash.add(s.name());
        for (const double number :
             {s.skew_ms, s.sigma_ms, s.exposure_ms, static_cast<double>(s.pictures),
              static_cast<double>(s.strays), static_cast<double>(s.pulses_apart)})
            hash.add(number);
    }
    return hash.hex();
}

SensorSkew read_sensor(const YamlSection& s) {
    SensorSkew sensor;
    sensor.rig = s.text("rig");
    const std::string side = s.text("side");
    if (side != "left" && side != "right")
        fail("'side' in {} is '{}', neither left nor right", s.name, side);
    sensor.is_left = side == "left";
    sensor.skew_ms = s.number("skew_ms");
    sensor.sigma_ms = s.deviation("sigma_ms");
    sensor.exposure_ms = s.number("exposure_ms");
    sensor.pictures = s.integer("pictures");
    sensor.strays = s.integer("strays");
    sensor.pulses_apart = s.integer("pulses_apart");
    return sensor;
}

SyncRecord read_record(const YamlSection& top) {
    SyncRecord record;
    record.date = top.text("date");
    record.tool = top.text("tool");
    record.rate_hz = top.number("rate_hz");
    record.bar_step_ms = top.number("bar_step_ms");
    record.reference = top.text("reference");
    const cv::FileNode sensors = top.get("sensors");
    const std::size_t count = sensors.isSeq() ? sensors.size() : 0;
    if (count < 1 || count > most_sensors)
        fail("'sensors' is to be a list of 1 to {} sensors", most_sensors);
    for (const cv::FileNode& node : sensors)
        record.sensors.push_back(
            read_sensor({node, "sensors[" + std::to_string(record.sensors.size()) + "]"}));
    require_checksum(top.text("checksum"), checksum_of(record));
    return record;
}

}  // namespace

double SyncRecord::worst_ms() const {
    const auto [first, last] = std::minmax_element(
        sensors.begin(), sensors.end(),
        [](const SensorSkew& a, const SensorSkew& b) { return a.skew_ms < b.skew_ms; });
    return last->skew_ms - first->skew_ms;
}

std::filesystem::path sync_file_of(const std::filesystem::path& stage_file) {
    return std::filesystem::path(stage_file).replace_extension(".sync.yaml");
}

SyncRecord load_sync(const std::filesystem::path& path) {
    return read_yaml(path, file_kind, read_record);
}

void save_sync(const std::filesystem::path& path, const SyncRecord& record) {
    cv::FileStorage file("sync.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
    file << "kind" << file_kind.kind << "version" << file_kind.version << "units" << file_units;
    file << "date" << record.date << "tool" << record.tool;
    file << "rate_hz" << record.rate_hz << "bar_step_ms" << record.bar_step_ms;
    file << "reference" << record.reference;
    file << "checksum" << checksum_text(checksum_of(record));
    file << "sensors"
         << "[";
    for (const SensorSkew& s : record.sensors)
        file << "{"
             << "rig" << s.rig << "side" << (s.is_left ? "left" : "right") << "skew_ms" << s.skew_ms
             << "sigma_ms" << s.sigma_ms << "exposure_ms" << s.exposure_ms << "pictures"
             << s.pictures << "strays" << s.strays << "pulses_apart" << s.pulses_apart << "}";
    file << "]";
    write_yaml_keeping_last(path, file.releaseAndGetString(), load_sync);
}

}  // namespace vantage
