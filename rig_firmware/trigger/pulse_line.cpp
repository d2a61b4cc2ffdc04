#include "rig_firmware/trigger/pulse_line.h"

#include <gpiod.hpp>
#include <system_error>

#include "common/base/error.h"
#include "rig_firmware/trigger/gpio_line.h"
#include "rig_firmware/trigger/line_request.h"

namespace vantage {
namespace {

class PretendedPulseLine final : public PulseLine {
  public:
    void set(bool) override {}
    std::string text() const override { return "a pretended line (timing only)"; }
};

class GpioPulseLine final : public PulseLine {
  public:
    explicit GpioPulseLine(const RigConfig::Trigger& trigger)
        : line_(find_gpio_line(trigger)),
          request_(request_line(line_, gpiod::line_settings()
                                           .set_direction(gpiod::line::direction::OUTPUT)
                                           .set_active_low(trigger.active_low)
                                           .set_output_value(gpiod::line::value::INACTIVE))) {}

    void set(bool pulse) override {
        try {
            request_.set_value(line_.offset,
                               pulse ? gpiod::line::value::ACTIVE : gpiod::line::value::INACTIVE);
        } catch (const std::exception& error) {
            fail("{} cannot be set any more: {}", line_.text(), error.what());
        }
    }
    std::string text() const override { return line_.text(); }

  private:
    GpioLine line_;
    gpiod::line_request request_;
};

}  // namespace

std::unique_ptr<PulseLine> open_pulse_line(const RigConfig::Trigger& trigger) {
    if (trigger.pretended) return std::make_unique<PretendedPulseLine>();
    return std::make_unique<GpioPulseLine>(trigger);
}

}  // namespace vantage
