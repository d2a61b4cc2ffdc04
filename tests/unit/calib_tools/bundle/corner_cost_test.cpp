#include "calib_tools/bundle/corner_cost.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

namespace vantage {
namespace {

Pose pose(const Eigen::Vector3d& w, const Eigen::Vector3d& t) {
    Pose p = Pose::Identity();
    p.linear() = rotation_of(w);
    p.translation() = t;
    return p;
}

/// A camera on a rig that looks at one corner of one board, or of one face of several.
struct Scene {
    Bundle bundle;
    BoardCorner corner{.board_m = {0.12, -0.07, 0.01}, .pixel = {300, 200}};
    std::vector<std::vector<double>> parameters;

    Scene(LensModel lens, bool has_faces, double change) {
        BundleCamera camera;
        camera.model.lens = lens;
        camera.camera_from_rig = pose({0.02, -0.1, 0.03}, {-0.06, 0.01, 0.02});
        bundle.cameras.push_back(camera);
        bundle.rigs.push_back({pose({0.3, 0.5, -0.2}, {0.5, -0.4, -2})});
        bundle.boards.push_back({pose({-0.2, 0.4, 1.1}, {0.2, 0.1, 0.3})});
        bundle.views.push_back({0, 0, {corner}});
        if (has_faces) bundle.faces.push_back({pose({1.2, -0.3, 0.4}, {0.1, 0.05, -0.1})});
        parameters = {{420, 430, 310, 240, 0.1, -0.05, 0.001, -0.002, 0.02, 0.01, -0.01, 0.005}};
        for (std::size_t block = 1; block < (has_faces ? 5u : 4u); ++block) {
            const double b = change * static_cast<double>(block);
            parameters.push_back({b, -0.6 * b, 0.3 * b, 0.1 * b, -0.2 * b, 0.05 * b});
        }
    }

    CornerCost cost() const { return {bundle, bundle.views[0], corner}; }

    bool evaluate(Eigen::Vector2d& residual, double** jacobians) const {
        std::vector<const double*> blocks;
        for (const std::vector<double>& block : parameters) blocks.push_back(block.data());
        return cost().Evaluate(blocks.data(), residual.data(), jacobians);
    }
};

struct Case {
    LensModel lens;
    bool has_faces;
    double change;  ///< size of the poses' changes
};

class CornerCostTest : public testing::TestWithParam<Case> {};

TEST_P(CornerCostTest, HasTheDerivativesOfItsResidual) {
    Scene scene(GetParam().lens, GetParam().has_faces, GetParam().change);
    std::vector<std::vector<double>> jacobians;
    for (const std::vector<double>& block : scene.parameters)
        jacobians.emplace_back(2 * block.size());
    std::vector<double*> to;
    for (std::vector<double>& jacobian : jacobians) to.push_back(jacobian.data());
    Eigen::Vector2d residual, without;
    ASSERT_TRUE(scene.evaluate(residual, to.data()));
    ASSERT_TRUE(scene.evaluate(without, nullptr));
    EXPECT_LT((residual - without).norm(), 1e-9);
    for (std::size_t block = 0; block < scene.parameters.size(); ++block)
        for (std::size_t i = 0; i < scene.parameters[block].size(); ++i) {
            double& value = scene.parameters[block][i];
            const double step = 1e-6 * std::max(1.0, std::abs(value)), at = value;
            Eigen::Vector2d more, less;
            value = at + step;
            ASSERT_TRUE(scene.evaluate(more, nullptr));
            value = at - step;
            ASSERT_TRUE(scene.evaluate(less, nullptr));
            value = at;
            for (int row = 0; row < 2; ++row) {
                const double expected = (more[row] - less[row]) / (2 * step);
                const double own =
                    jacobians[block]
                             [static_cast<std::size_t>(row) * scene.parameters[block].size() + i];
                EXPECT_NEAR(own, expected, 1e-5 * std::max(1.0, std::abs(expected)))
                    << "block " << block << ", parameter " << i << ", row " << row;
            }
        }
}

INSTANTIATE_TEST_SUITE_P(Lenses, CornerCostTest,
                         testing::Values(Case{LensModel::pinhole, false, 0},
                                         Case{LensModel::pinhole, false, 0.05},
                                         Case{LensModel::pinhole, true, 2e-5},
                                         Case{LensModel::fisheye, true, 0.05}));

TEST(CornerCost, FailsBehindTheCamera) {
    Scene scene(LensModel::pinhole, false, 0);
    scene.bundle.rigs[0].world_from_rig.translation().z() = 5;
    Eigen::Vector2d residual;
    EXPECT_FALSE(scene.evaluate(residual, nullptr));
}

/// Its prediction is Bundle's own.
TEST(CornerCost, IsTheBundlesResidual) {
    Scene scene(LensModel::pinhole, true, 0);
    CameraModel& model = scene.bundle.cameras[0].model;
    const std::vector<double>& lens = scene.parameters[0];
    model.fx_px = lens[0], model.fy_px = lens[1], model.cx_px = lens[2], model.cy_px = lens[3];
    model.distortion.assign(lens.begin() + 4, lens.end());
    Eigen::Vector2d residual;
    ASSERT_TRUE(scene.evaluate(residual, nullptr));
    EXPECT_LT((residual - scene.bundle.residual_px(scene.bundle.views[0], scene.corner)).norm(),
              1e-9);
}

}  // namespace
}  // namespace vantage
