#include "calib_tools/sync/exposure_fit.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

#include "common/board/median.h"

namespace vantage {
namespace {

constexpr double ns_a_ms = 1e6;
/// An LED whose share changes less than this over all exposures gives no information about them.
constexpr double least_range = 0.12;
/// An LED can be read as on or off if its share differs from 0.5 by at least this much in both
/// directions.
constexpr double readable_range = 0.35;
/// Smallest assumed noise of an LED's light as a share of its gain, for 8-bit images and light that
/// is not quite linear.
constexpr double least_noise = 0.003;
constexpr int looks_beside = 6;

/// Smallest and largest share of a square wave in exposures of one length.
std::pair<double, double> share_range(double half, double length) {
    const double waves = std::floor(length / (2 * half)), rest = length - waves * 2 * half;
    return {(waves * half + std::max(0.0, rest - half)) / length,
            (waves * half + std::min(rest, half)) / length};
}

/// One hypothesis that explains the light.
class Explanation {
  public:
    Explanation(const SyncBar& bar, const LedLight& seen, double length_ms)
        : bar_(bar),
          seen_(seen),
          pictures_(seen.light.rows()),
          leds_(seen.light.cols()),
          length_ms_(length_ms),
          dark_(leds_),
          gain_(leds_),
          speaks_(static_cast<std::size_t>(leds_), false),
          centres_(static_cast<std::size_t>(pictures_), 0.0),
          used_(static_cast<std::size_t>(pictures_), true) {}

    /// Initialises dark and gain from the extremes of every LED, and the centres from the code.
    /// Returns false if fewer than three LEDs can be read as on or off at this length.
    bool begin() {
        readable_ = 0;
        for (Eigen::Index k = 0; k < leds_; ++k) {
            const auto [low, high] = share_range(half_ms(k), length_ms_);
            const double least = seen_.light.col(k).minCoeff(),
                         most = seen_.light.col(k).maxCoeff();
            speaks_[index(k)] = high - low > least_range;
            const bool in_phase = length_ms_ < 2 * half_ms(k);
            if (readable_ != k || !in_phase || high - low < readable_range) continue;
            gain_(k) = (most - least) / (high - low);
            dark_(k) = least - gain_(k) * low;
            ++readable_;
        }
        if (readable_ < 3) return false;
        // Faster LEDs may have been seen at a few of their phases only, so that an average gain is
        // assumed.
        typical_gain_ = median({gain_.begin(), gain_.begin() + readable_});
        for (Eigen::Index k = readable_; k < leds_; ++k) {
            gain_(k) = typical_gain_;
            dark_(k) = seen_.light.col(k).mean() - gain_(k) / 2;
        }
        for (Eigen::Index i = 0; i < pictures_; ++i) read_code(i);
        return true;
    }

    /// Solves for centres, gains and darks in turn, each from the others, with the current length.
    void settle(int rounds, double reach) {
        constexpr double narrower = 0.7;
        for (; rounds > 0; --rounds, reach *= narrower) {
            regress();
            for (Eigen::Index i = 0; i < pictures_; ++i)
                centres_[index(i)] =
                    best_centre(i, centres_[index(i)], reach * search_ms(), looks_beside);
        }
        regress();
    }

    /// Finds the length, within this relative range, that explains most once everything else has
    /// converged.
    void fit_length(double within, int rounds, double reach) {
        leave_out_misfits();
        length_ms_ = golden_section(length_ms_ * (1 - within), length_ms_ * (1 + within),
                                    [&](double length_ms) {
                                        Explanation at = *this;
                                        at.length_ms_ = length_ms;
                                        at.settle(rounds, reach);
                                        return at.misfit();
                                    });
        settle(rounds, reach);
    }

    /// Excludes images that are explained far worse than most, for this iteration.
    void leave_out_misfits() {
        constexpr double usual_times = 16;  // in squared error: four times the usual deviation
        std::vector<double> costs;
        for (Eigen::Index i = 0; i < pictures_; ++i) costs.push_back(cost(i, centres_[index(i)]));
        const double least = least_noise * typical_gain_;
        const double limit = usual_times * std::max(median(costs), speaking() * least * least);
        for (Eigen::Index i = 0; i < pictures_; ++i) used_[index(i)] = costs[index(i)] <= limit;
    }

    /// RMS of the unexplained light as a share of the gain. Excluded images count as if all were
    /// that bad.
    double misfit() const {
        constexpr double of_left_out = 0.1;
        double sum = 0;
        for (Eigen::Index i = 0; i < pictures_; ++i)
            sum += used_[index(i)] ? share_of_gain(cost(i, centres_[index(i)]))
                                   : of_left_out * of_left_out;
        return std::sqrt(sum / static_cast<double>(pictures_));
    }

    ExposureFit result() const {
        ExposureFit fit;
        fit.length_ms = length_ms_;
        fit.misfit = misfit();
        fit.used = static_cast<int>(std::count(used_.begin(), used_.end(), true));
        double sum = 0;
        for (Eigen::Index i = 0; i < pictures_; ++i)
            if (used_[index(i)]) sum += cost(i, centres_[index(i)]);
        // n images with m LEDs have n centres, m gains, m darks and one length.
        const double m = speaking(), n = fit.used;
        const double noise = std::max(least_noise * typical_gain_,
                                      std::sqrt(sum / std::max(1.0, n * m - n - 2 * m - 1)));
        for (Eigen::Index i = 0; i < pictures_; ++i) fit.exposures.push_back(exposure(i, noise));
        return fit;
    }

  private:
    static std::size_t index(Eigen::Index i) { return static_cast<std::size_t>(i); }
    double half_ms(Eigen::Index k) const {
        return static_cast<double>(bar_.half_wave(seen_.leds[index(k)]).count()) / ns_a_ms;
    }
    double period_ms() const { return static_cast<double>(bar_.period().count()) / ns_a_ms; }
    double search_ms() const { return std::max(length_ms_, code_step_ms_) / 2; }
    double share(Eigen::Index k, double centre_ms, double length_ms) const {
        return bar_.lit_share(seen_.leds[index(k)], ns_a_ms * (centre_ms - length_ms / 2),
                              ns_a_ms * length_ms);
    }
    double speaking() const {
        return static_cast<double>(std::count(speaks_.begin(), speaks_.end(), true));
    }
    /// Mean over the LEDs of an image, in units of the gain, of a sum of squares.
    double share_of_gain(double squares) const {
        return squares / (speaking() * typical_gain_ * typical_gain_);
    }

    double cost(Eigen::Index i, double centre_ms, double length_ms) const {
        double sum = 0;
        for (Eigen::Index k = 0; k < leds_; ++k) {
            if (!speaks_[index(k)]) continue;
            const double miss =
                seen_.light(i, k) - dark_(k) - gain_(k) * share(k, centre_ms, length_ms);
            sum += miss * miss;
        }
        return sum;
    }
    double cost(Eigen::Index i, double centre_ms) const { return cost(i, centre_ms, length_ms_); }

    /// The readable LEDs are on or off at the middle of the exposure and form a Gray code of as
    /// many bits.
    void read_code(Eigen::Index i) {
        std::uint32_t lit = 0;
        for (Eigen::Index k = 0; k < readable_; ++k)
            lit = 2 * lit + (seen_.light(i, k) > dark_(k) + gain_(k) / 2 ? 1 : 0);
        code_step_ms_ = period_ms() / static_cast<double>(std::uint32_t{1} << readable_);
        const double middle_ms = (SyncBar::step_of(lit) + 0.5) * code_step_ms_;
        // One LED next to a step may have been misread.
        centres_[index(i)] = best_centre(i, middle_ms, 1.5 * code_step_ms_, 12);
    }

    /// Tries this number of positions on each side, then refines between the best one and its
    /// neighbours.
    double best_centre(Eigen::Index i, double around_ms, double reach_ms, int places) const {
        double best_ms = around_ms, least = cost(i, around_ms);
        const double step_ms = reach_ms / places;
        for (int place = -places; place <= places; ++place) {
            const double centre_ms = around_ms + place * step_ms, here = cost(i, centre_ms);
            if (here >= least) continue;
            least = here;
            best_ms = centre_ms;
        }
        return golden_section(best_ms - step_ms, best_ms + step_ms,
                              [&](double centre_ms) { return cost(i, centre_ms); });
    }

    template <class Function>
    static double golden_section(double low, double high, const Function& function) {
        constexpr double ratio = 0.6180339887498949;
        double a = high - ratio * (high - low), b = low + ratio * (high - low);
        double at_a = function(a), at_b = function(b);
        for (int step = 0; step < 16; ++step) {
            if (at_a <= at_b) {
                high = b;
                b = a;
                at_b = at_a;
                a = high - ratio * (high - low);
                at_a = function(a);
            } else {
                low = a;
                a = b;
                at_a = at_b;
                b = low + ratio * (high - low);
                at_b = function(b);
            }
        }
        return (low + high) / 2;
    }

    /// Regression for dark and gain of every LED from the shares of the exposures; where these
    /// hardly change, the gain is pulled towards the typical one.
    void regress() {
        constexpr double belief = 1e-4;  // prior for the typical gain, as a variance of shares
        std::vector<double> gains;
        for (Eigen::Index k = 0; k < leds_; ++k) {
            if (!speaks_[index(k)]) continue;
            double n = 0, x = 0, y = 0, xx = 0, xy = 0;
            for (Eigen::Index i = 0; i < pictures_; ++i) {
                if (!used_[index(i)]) continue;
                const double lit = share(k, centres_[index(i)], length_ms_);
                n += 1;
                x += lit;
                y += seen_.light(i, k);
                xx += lit * lit;
                xy += lit * seen_.light(i, k);
            }
            gain_(k) = std::max(0.0, (n * xy - x * y + belief * n * n * typical_gain_) /
                                         (n * xx - x * x + belief * n * n));
            dark_(k) = (y - gain_(k) * x) / n;
            gains.push_back(gain_(k));
        }
        typical_gain_ = median(gains);
    }

    /// The centre is where the light is explained as well as at the best position, within the noise
    /// (one standard deviation, or an interval in which no LED changes).
    Exposure exposure(Eigen::Index i, double noise) const {
        const double best = centres_[index(i)];
        const double limit = cost(i, best) + noise * noise;
        const double step_ms = length_ms_ / 500, furthest_ms = period_ms() / 4;
        double low = best, high = best;
        while (best - low < furthest_ms && cost(i, low) < limit) low -= step_ms;
        while (high - best < furthest_ms && cost(i, high) < limit) high += step_ms;
        double phase_ms = std::fmod((low + high) / 2, period_ms());
        if (phase_ms < 0) phase_ms += period_ms();
        bool changes = false;
        for (Eigen::Index k = 0; k < leds_; ++k) {
            const double lit = share(k, best, length_ms_);
            changes = changes || (speaks_[index(k)] && lit > least_noise && lit < 1 - least_noise);
        }
        return {.centre_ms = phase_ms,
                .sigma_ms = (high - low) / 2,
                .used = used_[index(i)],
                .is_resolved = changes};
    }

    const SyncBar& bar_;
    const LedLight& seen_;
    Eigen::Index pictures_, leds_;
    double length_ms_;
    double code_step_ms_ = 0, typical_gain_ = 0;
    Eigen::Index readable_ = 0;
    Eigen::VectorXd dark_, gain_;
    std::vector<bool> speaks_;
    std::vector<double> centres_;
    std::vector<bool> used_;
};

}  // namespace

ExposureFit fit_exposures(const SyncBar& bar, const LedLight& seen) {
    constexpr double ratio = 1.15, shortest_steps = 0.5;
    const double step_ms = static_cast<double>(bar.step().count()) / ns_a_ms;
    const double period_ms = static_cast<double>(bar.period().count()) / ns_a_ms;
    std::optional<Explanation> best;
    double least = std::numeric_limits<double>::infinity();
    double next_ms = shortest_steps * step_ms;
    while (next_ms < period_ms) {
        const double length_ms = std::exchange(next_ms, next_ms * ratio);
        Explanation way(bar, seen, length_ms);
        if (!way.begin()) continue;
        way.settle(1, 1);
        way.leave_out_misfits();
        way.settle(1, 0.5);
        if (way.misfit() >= least) continue;
        least = way.misfit();
        best.emplace(std::move(way));
    }
    if (!best) return {};
    best->fit_length(ratio - 1, 2, 0.5);
    best->fit_length(0.04, 3, 0.3);
    best->leave_out_misfits();
    best->settle(4, 0.2);
    return best->result();
}

}  // namespace vantage
