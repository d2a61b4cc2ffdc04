#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/gl/texture.h"
#include "common/receive/signal_state.h"
#include "host_app/desk/style.h"
#include "host_app/flight/corridor.h"
#include "host_app/flight/orbit_view.h"

namespace vantage {

enum class RigState { present, late, missed, disconnected, refused };

struct PanelRig {
    std::string name;
    RigState state = RigState::disconnected;
    double rate_hz = 0;                    ///< frames received a second
    double latency_ms = 0;                 ///< exposure to decoded, median
    std::uint64_t lost = 0;                ///< frames that met no set, wherever they were lost
    const Texture* disparity = nullptr;    ///< colour-mapped; null: none yet
    std::optional<double> set_known = {};  ///< share of its set; nothing: none is learnt
    std::vector<std::string> worries =
        {};  ///< what a technician should look after, a few words each
};

struct PanelStage {
    std::string name;
    double ms = 0;
    bool at_rig = false;
};

/// What the novelty overlay's colours say.
struct PanelNovelty {
    struct Row {
        std::string rig;
        unsigned char rgb[3] = {0, 0, 0};
        double share = 0;  ///< of the picture's pixels
    };
    std::vector<Row> rows;
    std::string remark;  ///< why there is no overlay; empty: there is one
};

/// The take that is recorded, or what ended it.
struct PanelTake {
    bool is_running = false;
    std::string path;
    double duration_s = 0, mb_s = 0;
    std::uint64_t left_out = 0;  ///< frames that came and are not in it
    std::string failure;
};

/// An output of the programme.
struct PanelOutput {
    std::string name, state;
    bool is_on = false, is_failed = false;
    double mbit_s = 0;
    std::uint64_t queued = 0, left_out = 0;
    std::string failure;
};

/// Where in the past the programme is: shares of what there is.
struct PanelTime {
    double speed = 0, at = 0;
    std::optional<double> in, out;
    bool loops = false;
};

/// All that the operator's screen tells.
struct PanelState {
    const Texture* picture = nullptr;  ///< the virtual view
    std::string timecode;
    std::uint64_t pulse = 0;
    bool waiting = true;  ///< no set has come yet
    SignalState signal = SignalState::live;
    bool recording = false;         ///< a film
    std::optional<PanelTake> take;  ///< nothing: no take is recorded
    std::vector<PanelOutput> outputs;
    bool programme_tally = false, preview_tally = false;  ///< as the vision mixer says
    std::string question;            ///< that a second press of a key answers; empty: none
    std::optional<double> behind_s;  ///< while in a stage's past: how far
    std::optional<PanelTime> time;   ///< while in the past, or in a take
    double picture_rate_hz = 0, latency_ms = 0;
    std::vector<float> latency_history_ms;  ///< oldest first
    std::string synthesiser, renderer;
    int render_level = 0, prepare_level = 0;  ///< of quality; 0 is the best
    std::vector<PanelStage> stages;
    std::vector<PanelRig> rigs;
    OrbitView view;
    std::optional<Coverage> coverage;     ///< of the view by the rigs; nothing: not known
    std::optional<double> move_progress;  ///< 0..1 while the camera is on a planned move
    std::string wheel;                    ///< what the jog wheel does; empty: there is none
    std::optional<PanelNovelty> novelty;  ///< while it is asked for
    bool show_panels = true, show_help = false;
    bool asks_to_end = false;  ///< Esc was pressed once
};

/// Lays out the whole screen in the current ImGui frame: the picture, letterboxed, with the panels
/// around its edges.
void draw_operator_screen(const PanelState& state, const UiFonts& fonts);

}  // namespace vantage
