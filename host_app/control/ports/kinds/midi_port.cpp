#include <map>
#include <thread>

#include <fmt/format.h>

#include "common/base/log.h"
#include "host_app/control/ports/control_port.h"
#include "host_app/control/ports/midi_sequencer.h"
#include "host_app/control/ports/midi_surface.h"

namespace vantage {
namespace {

using namespace std::chrono_literals;

constexpr int most_events_a_look = 256;
constexpr std::size_t most_surfaces = 16;
constexpr std::chrono::milliseconds midi_lamp_period{40}, stick_period{20};

class MidiPort final : public ControlPort {
  public:
    MidiPort(const OutputUrl& url, const ControlBench& bench)
        : bench_(bench),
          intake_(bench.operator_input),
          name_("control " + url.shown),
          map_(MidiMap::load(url.option("map").value_or(""))),
          sequencer_(url.place, name_) {
        url.require_options_of({"map"});
    }

    void serve(std::chrono::milliseconds most) override {
        std::optional<MidiSequencer::Event> event = sequencer_.next(std::min(most, stick_period));
        int looked_at = 0;
        for (; event && looked_at < most_events_a_look; ++looked_at) {
            take(*event);
            event = sequencer_.next(0ms);
        }
        if (event) take(*event);
        stats_.dropped += sequencer_.overrun() - seen_overrun_;
        seen_overrun_ = sequencer_.overrun();
        if (looked_at == most_events_a_look) std::this_thread::sleep_for(10ms);
        const MonotonicTime now = MonotonicClock::now();
        if (surfaces_.empty() && !is_told_) {
            is_told_ = true;
            log_info("{}: no surface is plugged in yet; one may be at any time", name_);
        }
        hold(now);
        light(now);
    }

  private:
    using Kind = MidiSequencer::Event::Kind;

    void take(const MidiSequencer::Event& event) {
        switch (event.kind) {
            case Kind::plugged:
                is_told_ = true;
                log_info("{}: {} is plugged in", name_, printable(event.name));
                (void)surface_at(event.place);
                break;
            case Kind::unplugged:
                // The springs of a lost surface cannot centre its sticks any more.
                if (surfaces_.erase(event.place) > 0)
                    log_info("{}: the surface at {}:{} is gone", name_, event.place.client,
                             event.place.port);
                break;
            case Kind::foreign:
                refuse(&PortStats::malformed, "a message that no surface sends");
                break;
            case Kind::message:
                obey(event);
                break;
        }
    }

    void obey(const MidiSequencer::Event& event) {
        MidiSurface* surface = surface_at(event.place);
        if (!surface) {
            ++stats_.dropped;
            return;
        }
        const MidiSurface::Outcome outcome = surface->take(event.message);
        switch (outcome.kind) {
            case MidiSurface::Outcome::Kind::malformed:
                refuse(&PortStats::malformed, outcome.refusal);
                break;
            case MidiSurface::Outcome::Kind::unknown:
                refuse(&PortStats::unknown, outcome.refusal);
                break;
            case MidiSurface::Outcome::Kind::heard:
                ++(!outcome.call || intake_.take(*outcome.call, MonotonicClock::now())
                       ? stats_.obeyed
                       : stats_.dropped);
                break;
        }
    }

    /// Returns null if there are too many surfaces.
    MidiSurface* surface_at(const MidiSequencer::Place& place) {
        const auto found = surfaces_.find(place);
        if (found != surfaces_.end()) return &found->second;
        if (surfaces_.size() >= most_surfaces) return nullptr;
        return &surfaces_.emplace(place, MidiSurface(map_)).first->second;
    }

    void hold(MonotonicTime now) {
        const double dt_s = std::chrono::duration<double>(now - held_).count();
        const bool is_first = held_ == MonotonicTime{};
        held_ = now;
        if (is_first) return;
        for (const auto& [place, surface] : surfaces_)
            if (const FlightInput input = surface.held(dt_s); input.is_any())
                (void)bench_.operator_input.put(input, now);
    }

    void light(MonotonicTime now) {
        if (now - lit_ < midi_lamp_period) return;
        lit_ = now;
        const ShowLamps shown = bench_.lamps.state();
        for (auto& [place, surface] : surfaces_)
            for (const MidiMessage& message : surface.due(shown))
                if (!sequencer_.send(place, message)) {
                    surface.forget_lamps();
                    break;
                }
    }

    ControlBench bench_;
    CommandIntake intake_;
    std::string name_;
    MidiMap map_;
    MidiSequencer sequencer_;
    std::map<MidiSequencer::Place, MidiSurface> surfaces_;
    MonotonicTime held_{}, lit_{};
    bool is_told_ = false;
    std::uint64_t seen_overrun_ = 0;
};

}  // namespace

PortEntry midi_port_entry() {
    return {"midi",
            "midi://NAME (surfaces with NAME in their name, or midi://all, on this computer; "
            "?map=FILE)",
            [](const OutputUrl& url, const ControlBench& bench) {
                return std::make_unique<MidiPort>(url, bench);
            }};
}

}  // namespace vantage
