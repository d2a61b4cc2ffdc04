#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "host_app/control/hid/jog_devices.h"
#include "host_app/control/hid/wheel_call.h"

namespace vantage {

/// The map of a wheel as it is changed, for whoever draws it.
struct WheelMapView {
    struct Control {
        JogControl control;
        std::string does;      ///< as its file has it: "shot 1", "wheel", "nothing"
        bool is_held = false;  ///< a button that is down, an axis off its rest
        double at = 0;         ///< of an axis -1..1; of what turns all detents so far
    };
    std::string name;  ///< of the wheel; empty: none has been plugged in
    std::string file;  ///< that it is saved in
    std::vector<Control> controls;
    std::size_t selected = 0;
    AxisMap feel;             ///< of the control in hand, unless that is a button
    double turned = 0;        ///< detents that it was turned by a moment ago
    bool is_changed = false;  ///< and not saved
    std::string remark;       ///< what the last call came to; empty: nothing to say
};

/// The maps of all wheels as hands change them while they fly: a change is one of the map's text,
/// which is read again as if it came from a file, so that what cannot be is refused in the same
/// words, and comments stay. While the map is open wheels are shown and move nothing. Any thread;
/// no lock is held over a file.
class WheelInput {
  public:
    /// Takes note of what happens at a wheel, and gives the event the map that is in force.
    void note(DeckEvent& event);

    /// There is a desk that shows the map: without one it never opens, and wheels move what they
    /// move.
    void serve_desk();
    void toggle();
    bool is_open() const;
    /// By one thread.
    void obey(const WheelCall& call);

    /// Nothing: it is closed.
    std::optional<WheelMapView> view(MonotonicTime now) const;
    /// Names of wheels whose maps are changed and not saved.
    std::vector<std::string> unsaved() const;

  private:
    struct Wheel {
        std::shared_ptr<const WheelProfile> profile;
        std::vector<JogControl> controls;
        std::string saved_text;  ///< of its file, as it was read or written last
        std::size_t selected = 0;
        std::map<std::string, double> at;
        double turned = 0;
        MonotonicTime turned_at{};
    };
    void note_control(Wheel& wheel, const JogEvent& event, MonotonicTime time);
    /// Returns what is to be said of it.
    static std::string obey(Wheel& wheel, const WheelCall& call);
    static void set(Wheel& wheel, const std::string& table, const std::string& key,
                    const std::string& value);
    static void assign(Wheel& wheel, const std::string& action);
    static void feel(Wheel& wheel, const WheelCall& call);
    static std::string save(Wheel& wheel);

    mutable std::mutex mutex_;
    bool has_desk_ = false, is_open_ = false;
    /// By the devices that a map is for.
    std::map<std::vector<JogId>, Wheel> wheels_;
    std::vector<JogId> in_hand_;  ///< of the wheel that was moved last; empty: none yet
    std::string remark_;
};

/// What this control does, as its file has it.
std::string action_of(const WheelProfile& profile, const JogControl& control);

}  // namespace vantage
