#include <set>

#include "base/error.h"
#include "base/log.h"
#include "scene/aov.h"
#include "scene/load_objects.h"
#include "scene/parse_value.h"
#include "scene/plugin.h"

namespace tachylite {
namespace {

/// "dd:depth, nn:sh_normal"
std::vector<std::string> read_aovs(const Plugin& plugin) {
  static const std::set<std::string_view> missing{"duv_dx", "duv_dy", "boundary_test"};
  std::vector<std::string> aovs;
  const std::string list = plugin.string("aovs", "");
  for (const std::string_view item : split_list(list)) {
    const size_t colon = item.find(':');
    const std::string_view type = colon == item.npos ? item : item.substr(colon + 1);
    if (missing.contains(type))
      plugin.loader().refuse(plugin.where("aovs"), fmt::format("the AOV {} is not supported", type));
    else
      aovs.emplace_back(item);
  }
  if (aovs.empty()) plugin.fail("aovs", "a list such as n:sh_normal, d:depth");
  try {
    parse_aovs(aovs);
  } catch (const InputError& error) {
    throw InputError(plugin.where("aovs"), error.what());
  }
  return aovs;
}

void load_nested(SceneLoader& loader, const Plugin& outer) {
  const SceneLoader::Nesting nesting(loader, outer.node());
  const XmlNode* inner = outer.object("integrator");
  if (!inner) throw InputError(outer.where(), fmt::format("{} holds no integrator", outer.type()));
  load_integrator(loader, *inner);
}

void read_depths(const Plugin& plugin, Integrator& integrator) {
  integrator.max_depth = plugin.integer("max_depth", -1, -1);
  integrator.rr_depth = plugin.integer("rr_depth", 5, 1);
}

/// `sampling`, ours: which strategies find the light. The number of samples of Mitsuba's `direct` says the same.
void read_strategy(const Plugin& plugin, Integrator& integrator) {
  if (!plugin.has("sampling")) return;
  for (const char* other : {"shading_samples", "emitter_samples", "bsdf_samples"})
    if (plugin.has(other))
      throw InputError(plugin.where("sampling"), fmt::format("direct has sampling as well as {}", other));
  const std::string word = plugin.word("sampling", "mis", {"mis", "emitter", "bsdf"});
  integrator.strategy = word == "emitter" ? Integrator::Strategy::kEmitterOnly
                        : word == "bsdf"  ? Integrator::Strategy::kBsdfOnly
                                          : Integrator::Strategy::kMis;
}

void read_direct(const Plugin& plugin, Integrator& integrator) {
  integrator.max_depth = 2;
  const int shading = plugin.integer("shading_samples", 1, 0);
  const int emitter = plugin.integer("emitter_samples", shading, 0);
  const int bsdf = plugin.integer("bsdf_samples", shading, 0);
  if (emitter + bsdf == 0)
    throw InputError(plugin.where(), "direct has neither emitter_samples nor bsdf_samples");
  if (emitter == 0) integrator.strategy = Integrator::Strategy::kBsdfOnly;
  if (bsdf == 0) integrator.strategy = Integrator::Strategy::kEmitterOnly;
}

}  // namespace

void load_integrator(SceneLoader& loader, const XmlNode& node) {
  const Plugin plugin(loader, node);
  const std::string& type = plugin.type();
  Integrator& integrator = loader.scene.integrator;
  integrator.where = node.where;
  if (type == "moment" || type == "aov") {
    if (type == "moment") integrator.moment = true;
    if (type == "aov") integrator.aovs = read_aovs(plugin);
    load_nested(loader, plugin);
  } else if (type == "direct") {
    integrator.kind = Integrator::Kind::kDirect;
    read_direct(plugin, integrator);
  } else if (type == "path" || type == "ptracer") {
    if (type == "ptracer")
      log_warning(fmt::format("{}: ptracer is answered by path: the same image", node.where.str()));
    integrator.kind = Integrator::Kind::kPath;
    read_depths(plugin, integrator);
  } else if (type == "volpath" || (node.legacy && type == "volpath_simple")) {
    integrator.kind = Integrator::Kind::kVolpath;
    read_depths(plugin, integrator);
  } else if (type == "volpathmis") {
    integrator.kind = Integrator::Kind::kVolpathMis;
    read_depths(plugin, integrator);
    plugin.boolean("use_spectral_mis", true);
  } else {
    loader.refuse(node.where, fmt::format("the integrator plugin {} is not supported: path is used", type));
    integrator.kind = Integrator::Kind::kPath;
    return;
  }
  if (type != "moment" && type != "aov") read_strategy(plugin, integrator);
  integrator.hide_emitters = plugin.boolean("hide_emitters", integrator.hide_emitters);
  if (node.legacy && plugin.boolean("strict_normals", false))
    loader.refuse(plugin.where("strict_normals"), "strictNormals is not supported");
  plugin.ignore({"block_size", "samples_per_pass", "timeout"});
  plugin.finish();
}

}  // namespace tachylite
