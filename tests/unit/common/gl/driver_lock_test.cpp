#include "common/gl/context/driver_lock.h"

#include <atomic>
#include <deque>
#include <future>
#include <memory>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <malloc.h>

#include "common/gl/context/context_group.h"
#include "common/gl/fullscreen_pass.h"
#include "common/gl/objects/fence.h"
#include "common/gl/objects/framebuffer.h"
#include "tests/unit/common/gl/shader_folder.h"

namespace vantage {
namespace {

TEST(DestroyedMutex, IsWaitedForWhileAnotherThreadHoldsIt) {
    pthread_mutex_t mutex;
    ASSERT_EQ(pthread_mutex_init(&mutex, nullptr), 0);
    std::atomic<bool> is_held = false, is_let_go = false;
    std::thread other([&] {
        pthread_mutex_lock(&mutex);
        is_held = true;
        std::this_thread::sleep_for(std::chrono::milliseconds(20));
        is_let_go = true;
        pthread_mutex_unlock(&mutex);
    });
    while (!is_held) std::this_thread::yield();
    EXPECT_EQ(pthread_mutex_destroy(&mutex), 0);
    EXPECT_TRUE(is_let_go);
    other.join();
}

TEST(DestroyedMutex, DoesNotBlockItsOwner) {
    pthread_mutex_t mutex;
    ASSERT_EQ(pthread_mutex_init(&mutex, nullptr), 0);
    pthread_mutex_lock(&mutex);
    EXPECT_EQ(pthread_mutex_destroy(&mutex), EBUSY) << "as the C library says";
    pthread_mutex_unlock(&mutex);
    EXPECT_EQ(pthread_mutex_destroy(&mutex), 0);
}

TEST(DriverLock, IsHeldByOneThreadAtATime) {
    std::mutex driver;
    std::atomic<bool> is_over = false;
    auto first = std::make_unique<DriverLock>(&driver);
    std::thread other([&] {
        const DriverLock second(&driver);
        EXPECT_TRUE(is_over);
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // It would be over already.
    is_over = true;
    first.reset();
    other.join();
}

TEST(DriverLock, IsFreeDuringAPause) {
    std::mutex driver;
    const DriverLock turn(&driver);
    {
        const DriverLock::Pause pause;
        const DriverLock::Pause within;  // Already another's.
        std::thread([&] { const DriverLock others(&driver); }).join();
    }
    EXPECT_FALSE(std::async(std::launch::async, [&] { return driver.try_lock(); }).get());
}

TEST(DriverLock, GoesToAnUrgentThreadFirst) {
    std::mutex driver;
    std::atomic<bool> has_begun = false, is_done = false;
    std::atomic<int> pauses = 0;
    std::thread busy([&] {
        const DriverLock turn(&driver);
        has_begun = true;
        // Releases the lock for moments only, as a thread that prepares does.
        while (!is_done) {
            std::this_thread::sleep_for(std::chrono::milliseconds(2));
            const DriverLock::Pause pause;
            ++pauses;
        }
    });
    while (!has_begun) std::this_thread::yield();
    int most = 0;
    for (int i = 0; i < 30; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(3));
        const int before = pauses;
        const DriverLock turn(&driver, DriverLock::Urgency::urgent);
        most = std::max(most, pauses - before);
    }
    is_done = true;
    busy.join();
    EXPECT_LE(most, 2) << "the one that was under way, and the next";
}

TEST(DriverLock, DoesNothingWithoutAMutex) {
    const DriverLock turn(nullptr);
    const DriverLock::Pause pause;
}

/// Draws from many textures, and uploads others meanwhile.
void draw_and_upload(const EglContext& context, const ShaderLibrary& library) {
    constexpr int rounds = 60, textures = 40, side_px = 64;
    const DriverLock turn(context.driver());
    const CurrentContext current(context);
    FullscreenPass pass(library, "copy.frag");
    Texture picture(TextureFormat::rgba8, side_px, side_px);
    const Framebuffer target({&picture});
    std::deque<Texture> sources;
    for (int i = 0; i < textures; ++i) sources.emplace_back(TextureFormat::r8, side_px, side_px);
    const cv::Mat1b white(side_px, side_px, std::uint8_t{255});
    for (int round = 0; round < rounds; ++round) {
        for (Texture& source : sources) {
            pass.use().set("source", 0);
            source.bind(0);
            pass.draw(target);
        }
        const Fence drawn = Fence::insert();
        for (Texture& source : sources) source.upload(white);
        drawn.wait("drawing from many textures");
    }
    EXPECT_EQ(picture.download().at<cv::Vec4b>(side_px / 2, side_px / 2)[0], 255);
}

/// Without turns llvmpipe before Mesa 25 reads there what it has freed, and dies if that is
/// overwritten.
TEST(DriverLock, KeepsContextsOfAProcessApart) {
    mallopt(M_PERTURB, 165);
    const ShaderFolder folder;
    folder.write("copy.frag",
                 "uniform sampler2D source;\n"
                 "layout(location = 0) out vec4 colour;\n"
                 "void main() { colour = texelFetch(source, ivec2(gl_FragCoord.xy), 0).rrrr; }");
    const ShaderLibrary library(folder.path());
    ContextGroup group;
    std::vector<std::thread> threads;
    for (int i = 0; i < 2; ++i)
        threads.emplace_back([&] { draw_and_upload(*group.join().context, library); });
    threads.emplace_back([&] { draw_and_upload(EglContext(), library); });
    for (std::thread& thread : threads) thread.join();
    mallopt(M_PERTURB, 0);
}

}  // namespace
}  // namespace vantage
