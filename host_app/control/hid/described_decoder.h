#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_family.h"

namespace vantage {

/// Position and type of one control in a jog wheel's reports.
struct ReportField {
    enum class Kind {
        delta,    ///< steps since the previous report
        counter,  ///< counts steps and wraps; the first report only sets the start
        axis,     ///< position of a spring-centred control, `full_scale` at its end
        buttons,  ///< a bit mask; bit n is the button NAME with the number n + 1
    };
    Kind kind = Kind::delta;
    std::string name;
    std::optional<std::uint8_t> report_id;  ///< empty if the device's reports have no id
    int byte = 0;                           ///< counted with the id, which is byte 0
    int bit = 0;                            ///< lowest bit within that byte, 0..7
    int bits = 8;                           ///< little-endian; 1..32
    bool is_signed = true;                  ///< for delta and axis
    double centre = 0;                      ///< for an axis: its value at rest
    double full_scale = 127;                ///< for an axis: distance from there to its end
};

/// Creates a decoder from the report description of a wheel's profile. It refuses reports with
/// another id, or too short for their fields.
std::unique_ptr<JogDecoder> make_described_decoder(std::vector<ReportField> fields);

}  // namespace vantage
