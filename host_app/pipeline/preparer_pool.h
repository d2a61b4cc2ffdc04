#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/gl/context/context_group.h"
#include "host_app/pipeline/instant_preparer.h"

namespace vantage {

using MakePreparer = std::function<std::unique_ptr<InstantPreparer>(const ShaderLibrary&)>;

/// Owns the instant preparers, one for each synthesiser, with the OpenGL contexts that their
/// objects live on. Preparers that failed and those of a lost context are destroyed once nobody
/// holds one of their instants. Belongs to one thread.
class PreparerPool {
  public:
    /// New preparers begin with `background` where it fits; null: with none. `contexts` must
    /// outlive the pool.
    PreparerPool(ContextGroup& contexts, std::shared_ptr<const Background> background)
        : contexts_(&contexts), background_(std::move(background)) {}

    /// Joins the newest generation of contexts. If the pool had joined it before, the preparer of
    /// `failed_synthesiser` is retired and made anew when it is next asked for. Throws as
    /// ContextGroup::join() does.
    ContextGroup::Member join(const std::string& failed_synthesiser);
    /// The generation that was joined last; 0: none.
    std::uint64_t generation() const {
        return generations_.empty() ? 0 : generations_.back().member.generation;
    }

    /// Returns the synthesiser's preparer and makes it first if there is none. Preparers stay when
    /// another synthesiser takes over, since drivers return little of their memory, and since their
    /// background stays learnt. Precondition: the joined context is current.
    std::shared_ptr<InstantPreparer> preparer_of(const std::string& synthesiser,
                                                 const MakePreparer& make,
                                                 const ShaderLibrary& shaders);
    /// Makes all preparers, also those made later, learn the background from nothing.
    void learn_background_anew();
    /// Destroys retired preparers, and those of lost generations, whose instants nobody holds.
    void release_unused();
    /// Drops the pool's hold on all preparers. Precondition: the joined context is current.
    void clear();

  private:
    struct Generation {
        ContextGroup::Member member;
        std::map<std::string, std::shared_ptr<InstantPreparer>> preparers;  ///< by synthesiser
        std::vector<std::shared_ptr<InstantPreparer>> retired;              ///< after a fault
    };

    ContextGroup* contexts_;
    std::shared_ptr<const Background> background_;
    std::vector<Generation> generations_;  ///< all but the last are lost
};

}  // namespace vantage
