#include "rig_firmware/trigger/line_request.h"

#include <algorithm>
#include <system_error>

#include "common/base/error.h"

namespace vantage {

gpiod::line_request request_line(const GpioLine& line, const gpiod::line_settings& settings) {
    return request_lines({line}, settings);
}

gpiod::line_request request_lines(const std::vector<GpioLine>& lines,
                                  const gpiod::line_settings& settings) {
    gpiod::line::offsets offsets;
    for (const GpioLine& line : lines) offsets.emplace_back(line.offset);
    try {
        return gpiod::chip(lines.front().chip)
            .prepare_request()
            .set_consumer("vantage")
            .add_line_settings(offsets, settings)
            .do_request();
    } catch (const std::system_error& error) {
        const auto used = std::find_if(lines.begin(), lines.end(),
                                       [](const GpioLine& line) { return line.is_used; });
        const GpioLine& line = used == lines.end() ? lines.front() : *used;
        if (error.code() == std::errc::device_or_resource_busy)
            fail("{} is held by {}: end that program, or name another line", line.text(),
                 line.consumer.empty() ? std::string("the kernel") : "'" + line.consumer + "'");
        fail("{} cannot be had: {}", line.text(), error.code().message());
    }
}

}  // namespace vantage
