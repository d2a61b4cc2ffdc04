#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>

namespace vantage {

/// Of a GPU or software rasteriser that several contexts share: who draws against the clock claims
/// it, and sliced drawing elsewhere (SlicedDrawing) waits between its bands until the claim ends.
/// Drivers know no such order: they take what comes, band for band.
class RenderPriority {
  public:
    /// Ends with its life.
    class Claim {
      public:
        explicit Claim(RenderPriority& way);
        ~Claim();
        Claim(const Claim&) = delete;
        Claim& operator=(const Claim&) = delete;

      private:
        RenderPriority* way_;
    };

    /// Waits while somebody claims it, for `longest` at most: who gives way goes on too, slowly.
    void give_way(std::chrono::nanoseconds longest);

  private:
    std::mutex mutex_;
    std::condition_variable freed_;
    int claims_ = 0;
};

}  // namespace vantage
