#include "stress/minimise_scene.h"

#include <algorithm>

namespace tachylite::test {
namespace {

class Minimiser {
 public:
  Minimiser(SceneText scene, const std::function<bool(const SceneText&)>& fails)
      : scene_(std::move(scene)), fails_(fails) {}

  SceneText run() {
    while (pass(scene_.elements)) {
    }
    drop_files();
    return std::move(scene_);
  }

 private:
  /// Whether anything could be left out of `elements`, which belong to scene_.
  bool pass(std::vector<Element>& elements) {
    bool changed = false;
    for (size_t i = 0; i < elements.size();) {
      const Element whole = elements[i];
      elements.erase(elements.begin() + static_cast<ptrdiff_t>(i));
      if (fails_(scene_)) {
        changed = true;
        continue;
      }
      elements.insert(elements.begin() + static_cast<ptrdiff_t>(i), whole);
      changed = replace_by_child(elements[i]) || changed;
      changed = pass(elements[i].children) || changed;
      ++i;
    }
    return changed;
  }

  /// An adapter by what it holds.
  bool replace_by_child(Element& element) {
    const Element whole = element;
    for (const Element& child : whole.children) {
      if (child.tag != whole.tag) continue;
      element = child;
      if (fails_(scene_)) return true;
      element = whole;
    }
    return false;
  }

  void drop_files() {
    const std::string xml = scene_.xml();
    std::erase_if(scene_.files, [&](const auto& file) { return xml.find('"' + file.first + '"') == xml.npos; });
  }

  SceneText scene_;
  const std::function<bool(const SceneText&)>& fails_;
};

}  // namespace

SceneText minimise_scene(SceneText scene, const std::function<bool(const SceneText&)>& fails) {
  return Minimiser(std::move(scene), fails).run();
}

}  // namespace tachylite::test
