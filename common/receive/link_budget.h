#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace vantage {

/// What a rig's frames weigh, as measured.
struct RigWeight {
    /// Of the colour picture, were it packed at another JPEG quality.
    struct AtQuality {
        int quality = 0;
        double colour_bytes = 0;
    };
    /// Of a smaller picture of the same things.
    struct AtScale {
        double scale = 1;         ///< of width and height
        double colour_share = 1;  ///< of the colour's bytes
    };
    std::string rig;
    int frames = 0;                   ///< that were measured
    double colour_bytes = 0;          ///< mean of a frame
    double other_bytes = 0;           ///< disparity and header, likewise
    std::vector<AtQuality> ladder{};  ///< from the best to the coarsest
    std::vector<AtScale> smaller{};   ///< from the largest to the smallest
};

struct LinkLimits {
    double rig_mbit_s = 1000, host_mbit_s = 1000;  ///< what the networks' interfaces say
    /// Rigs that a programme without a take asks for at a time; 0: all.
    std::size_t programme_rigs = 0;
};

/// What a stage asks of its networks.
struct LinkBudget {
    struct Rig {
        std::string rig;
        double mbit_s = 0;  ///< on the wire
        double share = 0;   ///< of what its link carries steadily; above 1 it does not fit
    };
    /// A way to make it fit: a JPEG quality, or every n-th pulse only, or both; smaller pictures;
    /// or only the rigs that a programme needs.
    struct Proposal {
        std::optional<int> jpeg_quality{};
        int rate_divisor = 1;
        double host_mbit_s = 0;
        double scale = 1;      ///< of width and height
        std::size_t rigs = 0;  ///< at a time; 0: all
    };
    std::vector<Rig> rigs;
    double host_mbit_s = 0, host_share = 0;
    std::vector<Proposal> proposals{};  ///< where it does not fit; of the best picture first

    bool fits() const;
};

/// Frames of `rate_hz` with what Ethernet, IP, TCP and the encryption add. Of a link four fifths
/// are planned for: frames come in bursts, and other programs send too.
LinkBudget plan_links(const std::vector<RigWeight>& weights, double rate_hz,
                      const LinkLimits& limits);

}  // namespace vantage
