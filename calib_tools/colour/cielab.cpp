#include "calib_tools/colour/cielab.h"

#include <numbers>

#include "common/colour/colour_correction.h"

namespace vantage {

Eigen::Vector3d lab_from_coded(const Eigen::Vector3d& coded) {
    return lab_from_linear(srgb_decode(coded[0]), srgb_decode(coded[1]), srgb_decode(coded[2]));
}

double delta_e_2000(const Eigen::Vector3d& lab_a, const Eigen::Vector3d& lab_b) {
    constexpr double pi = std::numbers::pi, degree = pi / 180;
    const auto seventh = [](double c) { return std::pow(c, 7); };
    const double mean_c = 0.5 * (lab_a.tail<2>().norm() + lab_b.tail<2>().norm());
    const double g = 0.5 * (1 - std::sqrt(seventh(mean_c) / (seventh(mean_c) + seventh(25))));
    const auto chroma = [&](const Eigen::Vector3d& lab) {
        return std::hypot((1 + g) * lab[1], lab[2]);
    };
    const auto hue = [&](const Eigen::Vector3d& lab) {
        if (lab[1] == 0 && lab[2] == 0) return 0.0;
        const double h = std::atan2(lab[2], (1 + g) * lab[1]);
        return h < 0 ? h + 2 * pi : h;
    };
    const double c1 = chroma(lab_a), c2 = chroma(lab_b), h1 = hue(lab_a), h2 = hue(lab_b);
    double dh = 0, mean_h = h1 + h2;
    if (c1 * c2 != 0) {
        dh = h2 - h1;
        if (dh > pi) dh -= 2 * pi;
        if (dh < -pi) dh += 2 * pi;
        mean_h = 0.5 * (h1 + h2);
        if (std::abs(h1 - h2) > pi) mean_h += h1 + h2 < 2 * pi ? pi : -pi;
    }
    const double dl = lab_b[0] - lab_a[0], dc = c2 - c1;
    const double d_hue = 2 * std::sqrt(c1 * c2) * std::sin(0.5 * dh);
    const double l = 0.5 * (lab_a[0] + lab_b[0]), c = 0.5 * (c1 + c2);
    const double t = 1 - 0.17 * std::cos(mean_h - 30 * degree) + 0.24 * std::cos(2 * mean_h) +
                     0.32 * std::cos(3 * mean_h + 6 * degree) -
                     0.20 * std::cos(4 * mean_h - 63 * degree);
    const double turn = 30 * degree * std::exp(-std::pow((mean_h / degree - 275) / 25, 2));
    const double rc = 2 * std::sqrt(seventh(c) / (seventh(c) + seventh(25)));
    const double l50 = (l - 50) * (l - 50);
    const double sl = 1 + 0.015 * l50 / std::sqrt(20 + l50), sc = 1 + 0.045 * c;
    const double sh = 1 + 0.015 * c * t;
    return std::sqrt(std::pow(dl / sl, 2) + std::pow(dc / sc, 2) + std::pow(d_hue / sh, 2) -
                     std::sin(2 * turn) * rc * (dc / sc) * (d_hue / sh));
}

}  // namespace vantage
