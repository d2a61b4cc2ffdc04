#include "rig_firmware/trigger/bar_lines.h"

#include <gpiod.hpp>

#include "common/base/error.h"
#include "rig_firmware/trigger/line_request.h"

namespace vantage {
namespace {

class PretendedBarLines final : public BarLines {
  public:
    void set(std::uint32_t, std::uint32_t) override {}
    std::string text() const override { return "pretended lines (timing only)"; }
};

class GpioBarLines final : public BarLines {
  public:
    GpioBarLines(std::vector<GpioLine> lines, bool active_low)
        : lines_(std::move(lines)),
          request_(request_lines(lines_, gpiod::line_settings()
                                             .set_direction(gpiod::line::direction::OUTPUT)
                                             .set_active_low(active_low)
                                             .set_output_value(gpiod::line::value::INACTIVE))) {
        values_.reserve(lines_.size());
    }

    void set(std::uint32_t lit, std::uint32_t changed) override {
        values_.clear();
        for (std::size_t led = 0; led < lines_.size(); ++led)
            if (changed >> led & 1)
                values_.emplace_back(lines_[led].offset, lit >> led & 1
                                                             ? gpiod::line::value::ACTIVE
                                                             : gpiod::line::value::INACTIVE);
        if (values_.empty()) return;
        try {
            request_.set_values(values_);
        } catch (const std::exception& error) {
            fail("the bar's lines of '{}' cannot be set any more: {}", lines_.front().label,
                 error.what());
        }
    }

    std::string text() const override {
        std::string names;
        for (const GpioLine& line : lines_) names += (names.empty() ? "" : ", ") + line.name;
        return names + " of '" + lines_.front().label + "'";
    }

  private:
    std::vector<GpioLine> lines_;
    gpiod::line_request request_;
    gpiod::line::value_mappings values_;
};

}  // namespace

std::unique_ptr<BarLines> open_bar_lines(const std::string& chip,
                                         const std::vector<std::string>& names, bool active_low) {
    std::vector<GpioLine> lines;
    for (const std::string& name : names) {
        RigConfig::Trigger wanted;
        wanted.chip = chip;
        wanted.line = name;
        lines.push_back(find_gpio_line(wanted));
        for (std::size_t other = 0; other + 1 < lines.size(); ++other)
            if (lines[other].offset == lines.back().offset)
                fail("the line {} is named twice: every LED has a line of its own", name);
    }
    return std::make_unique<GpioBarLines>(std::move(lines), active_low);
}

std::unique_ptr<BarLines> pretend_bar_lines() { return std::make_unique<PretendedBarLines>(); }

}  // namespace vantage
