#pragma once

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "common/receive/frame_set.h"
#include "host_app/flight/corridor.h"

namespace vantage {

/// Where the stage's rigs stand, for a plan of it.
struct StagePlaces {
    struct Rig {
        std::string name;
        CorridorRig rig;
        bool is_away = false;
    };
    std::vector<Rig> rigs;
    StageExtent extent;
};

/// The corridor of the rigs that give frames now. A rig that has given none for two seconds is
/// away, unless this host asked it for none; it belongs to the corridor again with its next frame.
class StageCorridor {
  public:
    /// `aspect`: height by width of the programme's picture.
    explicit StageCorridor(double aspect) : aspect_(aspect) {}

    /// Before the first look; sets are looked at in the order of time, each once or more.
    void begin(const StageExtent& extent) { extent_ = extent; }
    void look(const FrameSet& set);
    /// From any thread; null before the first look after begin().
    std::shared_ptr<const Corridor> now() const;
    /// From any thread; nothing before there is a corridor. Changes with it.
    std::optional<StagePlaces> places() const;

  private:
    struct Rig {
        CorridorRig rig;
        MonotonicTime seen{};
        bool is_away = false;
    };
    double aspect_;
    std::optional<StageExtent> extent_;
    std::map<std::string, Rig> rigs_;
    std::optional<MonotonicTime> looked_at_;
    mutable std::mutex mutex_;
    std::shared_ptr<const Corridor> now_;
    std::optional<StagePlaces> places_;
};

}  // namespace vantage
