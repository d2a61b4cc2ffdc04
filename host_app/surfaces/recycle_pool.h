#pragma once

#include <memory>
#include <mutex>
#include <vector>

namespace vantage {

/// A pool of objects that are slow to create (textures, buffers). An object whose last holder lets
/// go of it returns to the pool, with its content, from any thread, and is handed out again. The
/// owner of the pool creates and destroys objects; one that outlives the pool is destroyed when its
/// holder lets go.
template <class T>
class RecyclePool {
  public:
    /// Returns a free object, or a new one made from `arguments`.
    template <class... Arguments>
    std::shared_ptr<T> take(const Arguments&... arguments) {
        std::unique_ptr<T> one;
        {
            const std::lock_guard lock(shelf_->mutex);
            if (!shelf_->free.empty()) {
                one = std::move(shelf_->free.back());
                shelf_->free.pop_back();
            }
        }
        if (!one) one = std::make_unique<T>(arguments...);
        return {one.release(), [shelf = std::weak_ptr(shelf_)](T* back) {
                    std::unique_ptr<T> owned(back);
                    const std::shared_ptr<Shelf> there = shelf.lock();
                    if (!there) return;
                    const std::lock_guard lock(there->mutex);
                    there->free.push_back(std::move(owned));
                }};
    }

    /// Destroys the free objects.
    void drop_free() {
        const std::lock_guard lock(shelf_->mutex);
        shelf_->free.clear();
    }

  private:
    struct Shelf {
        std::mutex mutex;
        std::vector<std::unique_ptr<T>> free;
    };
    std::shared_ptr<Shelf> shelf_ = std::make_shared<Shelf>();
};

}  // namespace vantage
