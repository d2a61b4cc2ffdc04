#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace vantage {

/// Gives one renderer priority on a GPU or software rasteriser that several contexts share. The
/// renderer with a deadline claims it; sliced drawing of other contexts (SlicedDrawing) waits
/// between its bands until the claim ends. Drivers have no such priority. Thread-safe.
class RenderPriority {
  public:
    /// A claim that lasts as long as the object.
    class Claim {
      public:
        explicit Claim(RenderPriority& way);
        ~Claim();
        Claim(const Claim&) = delete;
        Claim& operator=(const Claim&) = delete;

      private:
        RenderPriority* way_;
    };

    /// Waits while there is a claim, but at most `longest`, so that background work never stops.
    void give_way(std::chrono::nanoseconds longest);

  private:
    std::mutex mutex_;
    std::condition_variable freed_;
    int claims_ = 0;
};

}  // namespace vantage
