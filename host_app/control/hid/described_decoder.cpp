#include "host_app/control/hid/described_decoder.h"

#include <algorithm>

#include <fmt/format.h>

#include "host_app/control/hid/jog_report.h"

namespace vantage {
namespace {

/// Sign-extends a two's complement number of `bits` bits.
std::int64_t with_sign(std::uint64_t value, int bits) {
    const std::uint64_t sign = std::uint64_t{1} << (bits - 1);
    return static_cast<std::int64_t>(value ^ sign) - static_cast<std::int64_t>(sign);
}

class DescribedDecoder final : public JogDecoder {
  public:
    explicit DescribedDecoder(std::vector<ReportField> fields) {
        for (ReportField& field : fields) readings_.push_back({std::move(field), {}, {}, {}});
    }

    std::vector<JogControl> controls() const override {
        std::vector<JogControl> all;
        for (const Reading& reading : readings_) {
            const ReportField& field = reading.field;
            if (field.kind == ReportField::Kind::buttons)
                for (int bit = 0; bit < field.bits; ++bit)
                    all.push_back({JogKind::button, button(field, bit)});
            else
                all.push_back(
                    {field.kind == ReportField::Kind::axis ? JogKind::axis : JogKind::step,
                     field.name});
        }
        return all;
    }

    bool decode(std::span<const std::uint8_t> report, std::vector<JogEvent>& events) override {
        bool is_known = false;
        for (const Reading& reading : readings_) {
            if (!is_in(reading.field, report)) continue;
            if (bytes_needed(reading.field) > report.size()) return false;
            is_known = true;
        }
        for (Reading& reading : readings_)
            if (is_in(reading.field, report)) decode_field(reading, report, events);
        return is_known;
    }

  private:
    struct Reading {
        ReportField field;
        std::optional<std::uint64_t> counter;
        AxisPosition axis;
        HeldButtons buttons;
    };

    static std::string button(const ReportField& field, int bit) {
        return fmt::format("{}{}", field.name, bit + 1);
    }
    static bool is_in(const ReportField& field, std::span<const std::uint8_t> report) {
        return !field.report_id || (!report.empty() && report[0] == *field.report_id);
    }
    static std::size_t bytes_needed(const ReportField& field) {
        return static_cast<std::size_t>(field.byte + (field.bit + field.bits + 7) / 8);
    }

    static void decode_field(Reading& reading, std::span<const std::uint8_t> report,
                             std::vector<JogEvent>& events) {
        const ReportField& field = reading.field;
        const auto first = static_cast<std::size_t>(field.byte);
        const std::uint64_t value =
            uint_at(report, first, bytes_needed(field) - first) >> field.bit &
            ((std::uint64_t{1} << field.bits) - 1);
        switch (field.kind) {
            case ReportField::Kind::delta: {
                const auto turned =
                    static_cast<double>(field.is_signed ? with_sign(value, field.bits)
                                                        : static_cast<std::int64_t>(value));
                if (turned != 0) events.push_back({JogKind::step, field.name, turned});
                break;
            }
            case ReportField::Kind::counter: {
                const std::uint64_t mask = (std::uint64_t{1} << field.bits) - 1;
                const std::uint64_t before = reading.counter.value_or(value);
                const std::int64_t turned = with_sign((value - before) & mask, field.bits);
                if (turned != 0)
                    events.push_back({JogKind::step, field.name, static_cast<double>(turned)});
                reading.counter = value;
                break;
            }
            case ReportField::Kind::axis: {
                const auto at =
                    static_cast<double>(field.is_signed ? with_sign(value, field.bits)
                                                        : static_cast<std::int64_t>(value));
                reading.axis.update(std::clamp((at - field.centre) / field.full_scale, -1.0, 1.0),
                                    field.name, events);
                break;
            }
            case ReportField::Kind::buttons:
                reading.buttons.update(
                    value, [&](int bit) { return button(field, bit); }, events);
                break;
        }
    }

    std::vector<Reading> readings_;
};

}  // namespace

std::unique_ptr<JogDecoder> make_described_decoder(std::vector<ReportField> fields) {
    return std::make_unique<DescribedDecoder>(std::move(fields));
}

}  // namespace vantage
