#include "calib_tools/colour/colour_match.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <ceres/autodiff_cost_function.h>
#include <ceres/loss_function.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <opencv2/imgproc.hpp>
#include <opencv2/mcc.hpp>

#include "calib_tools/colour/cielab.h"
#include "common/base/error.h"

namespace vantage {
namespace {

/// Nine entries of the matrix, row by row, then three logarithms of gamma.
using Parameters = std::array<double, 12>;
constexpr Parameters no_change{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0};
constexpr double darkest = 4.0 / 255, brightest = 250.0 / 255;
constexpr double huber_lab = 2;
// Small enough to count only where there are no samples, as for a colour that nobody wears.
constexpr double identity_weight = 0.5;

Eigen::Vector3d decode(const Eigen::Vector3d& coded) {
    return {srgb_decode(coded[0]), srgb_decode(coded[1]), srgb_decode(coded[2])};
}

template <class T>
Eigen::Matrix<T, 3, 1> corrected_lab(const T* p, const Eigen::Vector3d& linear) {
    using std::exp;
    using std::pow;
    T toned[3];
    for (int c = 0; c < 3; ++c) toned[c] = pow(T(std::max(linear[c], 1e-5)), exp(p[9 + c]));
    T out[3];
    for (int r = 0; r < 3; ++r)
        out[r] = p[3 * r] * toned[0] + p[3 * r + 1] * toned[1] + p[3 * r + 2] * toned[2];
    return lab_from_linear(out[0], out[1], out[2]);
}

struct PairResidual {
    Eigen::Vector3d a_linear, b_linear;
    template <class T>
    bool operator()(const T* a, const T* b, T* residual) const {
        Eigen::Map<Eigen::Matrix<T, 3, 1>>(residual, 3) =
            corrected_lab(a, a_linear) - corrected_lab(b, b_linear);
        return true;
    }
};

struct PatchResidual {
    Eigen::Vector3d seen_linear, true_lab;
    template <class T>
    bool operator()(const T* p, T* residual) const {
        Eigen::Map<Eigen::Matrix<T, 3, 1>>(residual, 3) =
            corrected_lab(p, seen_linear) - true_lab.cast<T>();
        return true;
    }
};

struct IdentityResidual {
    template <class T>
    bool operator()(const T* p, T* residual) const {
        for (std::size_t i = 0; i < no_change.size(); ++i)
            residual[i] = identity_weight * (p[i] - no_change[i]);
        return true;
    }
};

void add_identity(ceres::Problem& problem, Parameters& p) {
    problem.AddResidualBlock(new ceres::AutoDiffCostFunction<IdentityResidual, 12, 12>(
                                 std::make_unique<IdentityResidual>().release()),
                             nullptr, p.data());
}

void solve(ceres::Problem& problem) {
    ceres::Solver::Options options;
    options.linear_solver_type = ceres::DENSE_QR;
    options.max_num_iterations = 60;
    options.num_threads = 1;  // gives the same digits every time
    options.logging_type = ceres::SILENT;
    ceres::Solver::Summary summary;
    ceres::Solve(options, &problem, &summary);
    if (!summary.IsSolutionUsable())
        fail("no correction brings the cameras' colours together: were they filmed in one light?");
}

ColourCorrection correction_of(const Parameters& p) {
    ColourCorrection c;
    for (int r = 0; r < 3; ++r)
        for (int k = 0; k < 3; ++k) c.matrix(r, k) = p[static_cast<std::size_t>(3 * r + k)];
    for (int k = 0; k < 3; ++k) c.tone[k] = std::exp(p[static_cast<std::size_t>(9 + k)]);
    c.validate();
    return c;
}

bool measurable(const Eigen::Vector3d& coded) {
    return coded.maxCoeff() <= brightest && coded.maxCoeff() >= darkest;
}

constexpr unsigned char published[24][3] = {
    {115, 82, 68},   {194, 150, 130}, {98, 122, 157}, {87, 108, 67},   {133, 128, 177},
    {103, 189, 170}, {214, 126, 44},  {80, 91, 166},  {193, 90, 99},   {94, 60, 108},
    {157, 188, 64},  {224, 163, 46},  {56, 61, 150},  {70, 148, 73},   {175, 54, 60},
    {231, 199, 31},  {187, 86, 149},  {8, 133, 161},  {243, 243, 242}, {200, 200, 200},
    {160, 160, 160}, {122, 122, 121}, {85, 85, 85},   {52, 52, 52}};

}  // namespace

ColourMatch match_colours(int cameras, const std::vector<ColourPair>& pairs, int reference) {
    constexpr int fewest = 24;
    std::vector<Parameters> parameters(static_cast<std::size_t>(cameras), no_change);
    ceres::Problem::Options ownership;
    ownership.loss_function_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
    ceres::HuberLoss loss(huber_lab);
    ceres::Problem problem(ownership);
    for (Parameters& p : parameters) add_identity(problem, p);
    problem.SetParameterBlockConstant(parameters[static_cast<std::size_t>(reference)].data());
    ColourMatch match;
    match.cameras.resize(parameters.size());
    std::vector<ColourPair> used;
    for (const ColourPair& pair : pairs) {
        if (!measurable(pair.a_coded) || !measurable(pair.b_coded)) continue;
        used.push_back(pair);
        for (const int camera : {pair.a, pair.b})
            ++match.cameras[static_cast<std::size_t>(camera)].samples;
        problem.AddResidualBlock(new ceres::AutoDiffCostFunction<PairResidual, 3, 12, 12>(
                                     std::make_unique<PairResidual>(
                                         PairResidual{decode(pair.a_coded), decode(pair.b_coded)})
                                         .release()),
                                 &loss, parameters[static_cast<std::size_t>(pair.a)].data(),
                                 parameters[static_cast<std::size_t>(pair.b)].data());
    }
    for (std::size_t i = 0; i < match.cameras.size(); ++i)
        if (match.cameras[i].samples > 0 && match.cameras[i].samples < fewest)
            fail(
                "camera {} shares {} measurable places with the others and {} are needed: let the "
                "rigs see more of the same surfaces, neither dark nor burnt out",
                i + 1, match.cameras[i].samples, fewest);
    if (used.empty()) fail("no two cameras see the same surface");
    solve(problem);
    for (std::size_t i = 0; i < match.cameras.size(); ++i)
        match.cameras[i].correction =
            static_cast<int>(i) == reference ? ColourCorrection{} : correction_of(parameters[i]);
    for (const ColourPair& pair : used) {
        ColourMatch::Camera& a = match.cameras[static_cast<std::size_t>(pair.a)];
        ColourMatch::Camera& b = match.cameras[static_cast<std::size_t>(pair.b)];
        const double before =
            delta_e_2000(lab_from_coded(pair.a_coded), lab_from_coded(pair.b_coded));
        const double after = delta_e_2000(lab_from_coded(a.correction.apply(pair.a_coded)),
                                          lab_from_coded(b.correction.apply(pair.b_coded)));
        for (ColourMatch::Camera* camera : {&a, &b}) {
            camera->delta_e_before += before / camera->samples;
            camera->delta_e_after += after / camera->samples;
        }
        match.delta_e_before += before / static_cast<double>(used.size());
        match.delta_e_after += after / static_cast<double>(used.size());
    }
    return match;
}

ColourMatch::Camera match_chart(const std::vector<ColourPatch>& patches) {
    constexpr std::size_t fewest = 12;
    Parameters parameters = no_change;
    ceres::Problem problem;
    add_identity(problem, parameters);
    std::vector<ColourPatch> used;
    for (const ColourPatch& patch : patches) {
        if (!measurable(patch.seen_coded)) continue;
        used.push_back(patch);
        problem.AddResidualBlock(
            new ceres::AutoDiffCostFunction<PatchResidual, 3, 12>(
                std::make_unique<PatchResidual>(
                    PatchResidual{decode(patch.seen_coded), lab_from_coded(patch.true_coded)})
                    .release()),
            new ceres::HuberLoss(2 * huber_lab), parameters.data());
    }
    if (used.size() < fewest)
        fail(
            "{} of the chart's {} patches can be measured and {} are needed: the others are burnt "
            "out or black; change the exposure",
            used.size(), patches.size(), fewest);
    solve(problem);
    ColourMatch::Camera camera;
    camera.correction = correction_of(parameters);
    camera.samples = static_cast<int>(used.size());
    for (const ColourPatch& patch : used) {
        const Eigen::Vector3d wanted = lab_from_coded(patch.true_coded);
        camera.delta_e_before +=
            delta_e_2000(lab_from_coded(patch.seen_coded), wanted) / camera.samples;
        camera.delta_e_after +=
            delta_e_2000(lab_from_coded(camera.correction.apply(patch.seen_coded)), wanted) /
            camera.samples;
    }
    return camera;
}

std::vector<Eigen::Vector3d> chart_colours() {
    std::vector<Eigen::Vector3d> colours;
    for (const auto& c : published) colours.push_back(Eigen::Vector3d(c[0], c[1], c[2]) / 255);
    return colours;
}

std::optional<std::vector<ColourPatch>> find_chart(const ColourImage& picture) {
    cv::Mat bgr;
    cv::cvtColor(picture, bgr, cv::COLOR_RGBA2BGR);
    const cv::Ptr<cv::mcc::CCheckerDetector> detector = cv::mcc::CCheckerDetector::create();
    if (!detector->process(bgr, cv::mcc::MCC24, 1)) return std::nullopt;
    // 72 rows: R, G and B of every patch; column 1 holds the means.
    const cv::Mat charts = detector->getBestColorChecker()->getChartsRGB();
    const std::vector<Eigen::Vector3d> truth = chart_colours();
    if (charts.rows != static_cast<int>(3 * truth.size()) || charts.cols < 2) return std::nullopt;
    cv::Mat1d values;
    charts.convertTo(values, CV_64F);
    std::vector<ColourPatch> patches;
    for (std::size_t i = 0; i < truth.size(); ++i) {
        const int row = static_cast<int>(3 * i);
        patches.push_back(
            {Eigen::Vector3d(values(row, 1), values(row + 1, 1), values(row + 2, 1)) / 255,
             truth[i]});
    }
    return patches;
}

}  // namespace vantage
