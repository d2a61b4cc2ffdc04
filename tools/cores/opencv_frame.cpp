// Matches one pair REPEATS times with OpenCV on one thread, for tools/cores.sh: opencv_frame MODE
// WIDTH HEIGHT DISPARITIES REPEATS, where MODE is 3way or bm. The pair is noise of two scales, and
// its right picture is the left one shifted by 20 px.
#include <cstdlib>
#include <cstring>
#include <iostream>

#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

int main(int argc, char** argv) {
    if (argc != 6) return 2;
    const int width = std::atoi(argv[2]), height = std::atoi(argv[3]),
              disparities = std::atoi(argv[4]);
    cv::setNumThreads(1);
    cv::RNG random(7);
    constexpr int shift = 20, coarse = 8;
    cv::Mat fine(height, width + shift, CV_8U), rough(height / coarse, width / coarse, CV_8U),
        scaled;
    random.fill(fine, cv::RNG::UNIFORM, 0, 100);
    random.fill(rough, cv::RNG::UNIFORM, 0, 156);
    cv::resize(rough, scaled, fine.size(), 0, 0, cv::INTER_CUBIC);
    const cv::Mat scene = fine + scaled;
    const cv::Mat left = scene.colRange(0, width).clone(),
                  right = scene.colRange(shift, width + shift).clone();
    cv::Ptr<cv::StereoMatcher> matcher;
    if (std::strcmp(argv[1], "bm") == 0)
        matcher = cv::StereoBM::create(disparities, 15);
    else  // the settings of docs/results/stereo.md
        matcher = cv::StereoSGBM::create(0, disparities, 3, 72, 288, 1, 15, 10, 100, 2,
                                         cv::StereoSGBM::MODE_SGBM_3WAY);
    cv::Mat result;
    for (int repeat = 0; repeat < std::atoi(argv[5]); ++repeat)
        matcher->compute(left, right, result);
    // The exact shift in OpenCV's sixteenths, or the matcher did not work.
    const int found = result.empty() ? 16 * shift : result.at<short>(height / 2, width / 2);
    std::cout << found / 16.0 << "\n";
    return std::abs(found - 16 * shift) <= 8 ? 0 : 1;
}
