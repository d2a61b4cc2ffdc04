#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "common/base/trace/trace_file.h"
#include "common/config/stage_config.h"
#include "host_app/desk/desk_arrangement.h"
#include "host_app/flight/moves/flight_store.h"
#include "host_app/replay/clip.h"
#include "host_app/session/live_show.h"
#include "host_app/session/options/common_options.h"

namespace vantage {

/// The options that `vantage live` and `vantage play` share. An empty string means that the option
/// was not given.
struct ShowOptions {
    std::string path, flight, clips, desk, snapshot, film, contact_sheet, size, synthesiser, wheels,
        encoder, rate;
    std::string background, saved_background;
    std::string metrics, web, audio, trace;
    std::optional<double> audio_delay_ms;
    std::vector<std::string> outputs, controls;
    std::string quality = "auto";
    std::uint64_t frames = 0;
    double seconds = 0;
    bool headless = false, json = false, source_map = false, compensate_gains = true,
         overwrite = false;
    bool free_flight = false;
    StereoscopicOptions stereoscopic;
    std::optional<bool> jog;  ///< default: with a window

    /// Adds the options. `owner` names the owner of the defaults in the help: "the stage's".
    void add_to(CLI::App& command, const std::string& owner);

    // These build the parts of a session and throw Error for options that do not fit.

    LiveSettings settings(const StageConfig::View& view, double pulse_rate_hz) const;
    /// `flights` holds the stored shots and moves.
    FlightPlan plan(const StageConfig::View& view, FlightStore& flights) const;
    /// `beside` is the file of the stage or the take. Throws Error as load_flight() does.
    FlightStore flight_store(const std::string& beside) const;
    /// Throws Error as load_clips() does.
    ClipStore clip_store(const std::string& beside, double pulse_rate_hz) const;
    /// Nothing without a window. Throws Error as load_desk() does.
    std::optional<DeskStore> desk_store(const std::string& beside) const;
    /// Begins the trace of --trace; null without it. Throws Error as TraceFile does.
    std::unique_ptr<TraceFile> make_trace(const std::string& program) const;
    /// Null without jog wheels.
    std::unique_ptr<JogDevices> make_deck() const;
    /// Opens the sound of --audio, or else plays `source`; null: no sound. `tap` gives the sound to
    /// a take. Throws Error as open_sound() does.
    std::shared_ptr<PictureSound> sound(double rate_hz, const SoundTap& tap,
                                        std::shared_ptr<SoundSource> source = nullptr) const;
};

}  // namespace vantage
