#pragma once

// Internals of load_xml: what the readers of single kinds of objects share.

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <set>
#include <string>

#include "scene/load_xml.h"
#include "scene/scene.h"
#include "scene/xml_node.h"

namespace tachylite {

class SceneLoader {
 public:
  SceneLoader(XmlTree tree, const LoadOptions& options);
  Scene load();

  /// What we do not know: an error, or under --permissive a warning (then the caller goes on without it).
  void refuse(const FileLocation& where, const std::string& message) const;

  /// The file that a parameter of `node` names; throws when it does not exist.
  std::filesystem::path find_file(const XmlNode& node, const std::string& name);

  /// `node` itself, or what it refers to when it is a <ref>.
  const XmlNode& resolve(const XmlNode& node) const;

  /// To be held while an object is read that may hold others: throws where these refer back to it, or where references
  /// lead too deep.
  class Nesting {
   public:
    Nesting(SceneLoader& loader, const XmlNode& node);
    ~Nesting() { loader_.loading_.erase(&node_); }
    Nesting(const Nesting&) = delete;
    Nesting& operator=(const Nesting&) = delete;

   private:
    SceneLoader& loader_;
    const XmlNode& node_;
  };

  /// Index of the object that `node` describes; read once however often it is referred to.
  TextureIndex texture(const XmlNode& node);
  BsdfIndex bsdf(const XmlNode& node);
  MediumIndex medium(const XmlNode& node);
  /// A texture of one colour.
  TextureIndex constant_texture(const FileLocation& where, const dvec3& color);
  /// The bsdf of shapes that name none, made once under that name.
  BsdfIndex default_bsdf(const std::string& name, const BsdfKind& kind);
  /// The bsdf with all its opaque parts two-sided; made once.
  BsdfIndex two_sided_bsdf(BsdfIndex index);
  bool permissive() const { return permissive_; }

  /// Runs `load` after all XML has been read, in parallel with others; then all `finish` in the order of the
  /// calls. `load` must touch only what it owns.
  void defer(std::function<void()> load, std::function<void()> finish);
  /// The job's result under `key`, made by `load` once; filled when `finish` functions run.
  template <typename T>
  std::shared_ptr<std::shared_ptr<const T>> deferred_file(const std::string& key,
                                                          std::function<std::shared_ptr<const T>()> load) {
    auto& slot = files_[key];
    if (!slot) {
      auto result = std::make_shared<std::shared_ptr<const T>>();
      defer([result, load = std::move(load)] { *result = load(); }, [] {});
      slot = result;
    }
    return std::static_pointer_cast<std::shared_ptr<const T>>(slot);
  }

  Scene scene;

 private:
  struct Job {
    std::function<void()> load, finish;
  };

  void note_ids(const XmlNode& node);
  void run_jobs();
  void load_used();
  void load_unused();
  void check_mesh_attributes() const;
  /// Memoises.
  int once(const XmlNode& node, const std::function<int()>& load);

  XmlTree tree_;
  bool permissive_;
  std::filesystem::path folder_;
  std::map<std::string, const XmlNode*> ids_;
  std::map<const XmlNode*, int> loaded_;
  std::set<const XmlNode*> loading_;
  std::set<TextureIndex> textures_seen_;                     // by the bsdf that is being read
  std::map<BsdfIndex, std::set<TextureIndex>> textures_of_;  // of a bsdf and those inside it
  std::map<std::string, BsdfIndex> defaults_;
  std::map<BsdfIndex, BsdfIndex> two_sided_;
  std::map<std::string, std::shared_ptr<void>> files_;
  std::set<std::string> files_named_;
  std::vector<Job> jobs_;
};

}  // namespace tachylite
