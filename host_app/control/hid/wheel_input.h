#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_devices.h"

namespace vantage {

/// Operator's request to the editor of a wheel's map.
struct WheelCall {
    enum class Action {
        select_by,  ///< moves the selection by `amount` controls
        select,     ///< selects the control called `words`
        assign,     ///< assigns `words`, a command or "nothing", to the selected control
        // change the response of the selected control by `amount` small steps
        steps,
        dead_zone,
        curve,
        invert,
        save,
        close,
    };
    Action action = Action::close;
    int amount = 0;
    std::string words = {};

    bool operator==(const WheelCall&) const = default;
};

/// State of the wheel map editor, for the desk to draw.
struct WheelMapView {
    struct Control {
        JogControl control;
        std::string does;      ///< as in its file: "shot 1", "wheel", "nothing"
        bool is_held = false;  ///< a pressed button, or an axis off its rest position
        double at = 0;         ///< position -1..1 of an axis; sum of all detents for other controls
    };
    std::string name;  ///< name of the wheel; empty if none has been plugged in
    std::string file;  ///< file that the map is saved in
    std::vector<Control> controls;
    std::size_t selected = 0;
    AxisMap feel;             ///< response of the selected control, unless it is a button
    double turned = 0;        ///< detents that it was just turned by
    bool is_changed = false;  ///< changed and not saved
    std::string remark;       ///< result of the last request; empty if there is nothing to report
};

/// Editor of the maps of all wheels during a show. Each change edits the map's text, which is then
/// parsed like a file: invalid values are refused with the same messages, and comments stay. While
/// the editor is open, wheels are shown and move nothing. Thread-safe; no lock is held while a file
/// is written.
class WheelInput {
  public:
    /// Records an event of a wheel and attaches the current map to it.
    void note(DeckEvent& event);

    /// Declares that a desk shows the editor. Without a desk it never opens, and wheels keep their
    /// effect.
    void serve_desk();
    void toggle();
    bool is_open() const;
    /// Executes a request. Call it from one thread.
    void obey(const WheelCall& call);

    /// Returns nothing while the editor is closed.
    std::optional<WheelMapView> view(MonotonicTime now) const;
    /// Names of wheels whose maps have unsaved changes.
    std::vector<std::string> unsaved() const;

  private:
    struct Wheel {
        std::shared_ptr<const WheelProfile> profile;
        std::vector<JogControl> controls;
        std::string saved_text;  ///< content of its file, as last read or written
        std::size_t selected = 0;
        std::map<std::string, double> at;
        double turned = 0;
        MonotonicTime turned_at{};
    };
    void note_control(Wheel& wheel, const JogEvent& event, MonotonicTime time);
    /// Executes a request on one wheel. Returns the message to show.
    static std::string obey(Wheel& wheel, const WheelCall& call);
    static void set(Wheel& wheel, const std::string& table, const std::string& key,
                    const std::string& value);
    static void assign(Wheel& wheel, const std::string& action);
    static void feel(Wheel& wheel, const WheelCall& call);
    static std::string save(Wheel& wheel);

    mutable std::mutex mutex_;
    bool has_desk_ = false, is_open_ = false;
    /// Wheels by the devices that their maps are for.
    std::map<std::vector<JogId>, Wheel> wheels_;
    std::vector<JogId> in_hand_;  ///< ids of the wheel that was moved last; empty: none yet
    std::string remark_;
};

/// Action of this control, as in its file.
std::string action_of(const WheelProfile& profile, const JogControl& control);

}  // namespace vantage
