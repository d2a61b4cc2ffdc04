#include "rig_firmware/clock/ptp_state_file.h"

#include <span>
#include <string>

#include <nlohmann/json.hpp>

#include "common/base/error.h"
#include "common/base/files/atomic_file.h"

namespace vantage {

nlohmann::ordered_json to_json(const std::optional<PtpReading>& reading, MonotonicTime now) {
    if (!reading) return {{"monotonic_ns", to_ns(now)}, {"port_state", nullptr}};
    return {{"monotonic_ns", to_ns(now)},
            {"port_state", reading->ptp.port_state},
            {"offset_ns", reading->ptp.offset_ns},
            {"path_delay_ns", reading->ptp.path_delay_ns},
            {"steps_removed", reading->ptp.steps_removed},
            {"tai_offset_s", reading->kernel.tai_offset_s},
            {"is_synchronized", reading->kernel.is_synchronized},
            {"was_set_lately", reading->kernel.was_set_lately},
            {"disciplined", reading->is_disciplined()}};
}

void write_ptp_state(const std::filesystem::path& file, const PtpReading& reading,
                     MonotonicTime now) {
    const std::string text = to_json(reading, now).dump() + "\n";
    write_file_atomically(file, std::as_bytes(std::span(text)));
}

std::optional<PtpReading> read_ptp_state(const std::filesystem::path& file, MonotonicTime now) {
    constexpr std::size_t max_bytes = 4096;
    std::error_code ignored;
    if (!std::filesystem::is_regular_file(file, ignored)) return std::nullopt;
    try {
        const std::vector<std::byte> bytes = read_file(file, max_bytes);
        const auto* text = reinterpret_cast<const char*>(bytes.data());
        const nlohmann::json json = nlohmann::json::parse(text, text + bytes.size());
        const auto age = now - monotonic_from_ns(json.at("monotonic_ns").get<std::int64_t>());
        if (age < std::chrono::seconds(0) || age > ptp_state_lifetime) return std::nullopt;
        return PtpReading{.ptp = {.port_state = json.at("port_state").get<std::string>(),
                                  .offset_ns = json.at("offset_ns").get<double>(),
                                  .path_delay_ns = json.at("path_delay_ns").get<double>(),
                                  .steps_removed = json.at("steps_removed").get<int>()},
                          .kernel = {.tai_offset_s = json.at("tai_offset_s").get<int>(),
                                     .is_synchronized = json.at("is_synchronized").get<bool>(),
                                     .was_set_lately = json.at("was_set_lately").get<bool>()}};
    } catch (const Error&) {
        return std::nullopt;  // it may go between the question and the reading
    } catch (const nlohmann::json::exception&) {
        return std::nullopt;
    }
}

std::optional<PtpReading> read_ptp() {
    if (std::optional<PtpReading> reading = read_ptp_state(ptp_state_file, MonotonicClock::now()))
        return reading;
    if (const std::optional<PtpState> state = read_ptp4l())
        return PtpReading{.ptp = *state, .kernel = read_kernel_clock()};
    return std::nullopt;
}

}  // namespace vantage
