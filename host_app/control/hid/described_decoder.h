#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_decoder.h"

namespace vantage {

/// Where one control stands in a wheel's reports.
struct ReportField {
    enum class Kind {
        delta,    ///< steps since the report before
        counter,  ///< counts steps and wraps; the first report is only where it starts
        axis,     ///< position of a spring-centred control, `full_scale` at its end
        buttons,  ///< a mask; bit n is the button NAME with n + 1 behind it
    };
    Kind kind = Kind::delta;
    std::string name;
    std::optional<std::uint8_t> report_id;  ///< without one the device's reports have none
    int byte = 0;                           ///< the id's own byte counts, as byte 0
    int bit = 0;                            ///< lowest bit within that byte, 0..7
    int bits = 8;                           ///< little-endian; 1..32
    bool is_signed = true;                  ///< of delta and axis
    double centre = 0;                      ///< of an axis: its value at rest
    double full_scale = 127;                ///< of an axis: how far from there its end is
};

/// A decoder for a wheel that is described and not known: a report of another id or one that is too
/// short for its fields is refused.
std::unique_ptr<JogDecoder> make_described_decoder(std::vector<ReportField> fields);

}  // namespace vantage
