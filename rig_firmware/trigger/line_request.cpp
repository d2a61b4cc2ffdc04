#include "rig_firmware/trigger/line_request.h"

#include <system_error>

#include "common/base/error.h"

namespace vantage {

gpiod::line_request request_line(const GpioLine& line, const gpiod::line_settings& settings) {
    try {
        return gpiod::chip(line.chip)
            .prepare_request()
            .set_consumer("vantage")
            .add_line_settings(gpiod::line::offset(line.offset), settings)
            .do_request();
    } catch (const std::system_error& error) {
        if (error.code() == std::errc::device_or_resource_busy)
            fail("{} is held by {}: end that program, or name another line in [trigger]",
                 line.text(),
                 line.consumer.empty() ? std::string("the kernel") : "'" + line.consumer + "'");
        fail("{} cannot be had: {}", line.text(), error.code().message());
    }
}

}  // namespace vantage
