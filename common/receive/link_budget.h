#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// The measured size of a rig's frames.
struct RigWeight {
    /// The size of the colour image at another JPEG quality.
    struct AtQuality {
        int quality = 0;
        double colour_bytes = 0;
    };
    /// The size of a smaller image of the same scene.
    struct AtScale {
        double scale = 1;         ///< of width and height
        double colour_share = 1;  ///< of the colour image's bytes
    };
    std::string rig;
    int frames = 0;                   ///< number of measured frames
    double colour_bytes = 0;          ///< mean per frame
    double other_bytes = 0;           ///< disparity and header, mean per frame
    std::vector<AtQuality> ladder{};  ///< from the best quality to the lowest
    std::vector<AtScale> smaller{};   ///< from the largest image to the smallest
    bool by_datagrams = false;        ///< the frames go over SRT, with its error correction
};

struct LinkLimits {
    double rig_mbit_s = 1000, host_mbit_s = 1000;  ///< nominal rates of the network interfaces
    /// Number of rigs that a programme without a recording asks for at a time; 0: all.
    std::size_t programme_rigs = 0;
};

/// The network load of a stage.
struct LinkBudget {
    struct Rig {
        std::string rig;
        double mbit_s = 0;  ///< on the wire
        double share = 0;   ///< of the planned capacity; above 1 it does not fit
    };
    /// A way to make the stage fit: a JPEG quality, a rate divisor, or both; smaller images; or
    /// only the rigs that a programme needs.
    struct Proposal {
        std::optional<int> jpeg_quality{};
        int rate_divisor = 1;
        double host_mbit_s = 0;
        double scale = 1;      ///< of width and height
        std::size_t rigs = 0;  ///< at a time; 0: all
    };
    std::vector<Rig> rigs;
    double host_mbit_s = 0, host_share = 0;
    std::vector<Proposal> proposals{};  ///< if it does not fit; best picture first

    bool fits() const;
};

/// Computes the load at `rate_hz`, including the overhead of Ethernet, IP, TCP or SRT, and
/// encryption. Four fifths of a link are planned for, since frames come in bursts and other
/// programs send, too.
LinkBudget plan_links(const std::vector<RigWeight>& weights, double rate_hz,
                      const LinkLimits& limits);

}  // namespace vantage
