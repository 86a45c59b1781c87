#include "stress/scale_scene.h"

#include <algorithm>
#include <sstream>
#include <vector>

namespace tachylite::test {
namespace {

class Scaler {
 public:
  explicit Scaler(double factor) : factor_(factor) {}

  void scale(Element& element) const {
    const std::string* type = element.attribute("type");
    if (element.tag == "shape" || (element.tag == "volume" && *type == "gridvolume")) scale_place(element);
    if (element.tag == "sensor") scale_sensor(element, *type);
    if (element.tag == "emitter") scale_emitter(element, *type);
    if (element.tag == "medium") multiply(element, "scale", 1 / factor_);
    if (element.tag == "bsdf" && *type == "bumpmap") multiply(element, "scale", factor_);
    for (Element& child : element.children) scale(child);
  }

 private:
  static Element* find(Element& element, const std::string& name) {
    const auto found = std::find_if(element.children.begin(), element.children.end(), [&](const Element& child) {
      return child.attribute("name") && *child.attribute("name") == name;
    });
    return found == element.children.end() ? nullptr : &*found;
  }

  /// All numbers of an attribute.
  static void multiply(std::string& text, double factor) {
    std::string numbers = text, out;
    std::replace(numbers.begin(), numbers.end(), ',', ' ');
    std::istringstream in(numbers);
    for (double x; in >> x;) out += fmt::format("{}{:.9g}", out.empty() ? "" : ", ", factor * x);
    text = out;
  }
  static void multiply_attribute(Element& element, const std::string& key, double factor) {
    for (auto& [name, value] : element.attributes)
      if (name == key) multiply(value, factor);
  }
  /// A parameter; `by_default` is what it is where it is not given.
  static void multiply(Element& element, const std::string& name, double factor, double by_default = 1) {
    if (find(element, name) == nullptr) element.add(parameter("float", name, fmt::format("{}", by_default)));
    multiply_attribute(*find(element, name), "value", factor);
  }

  /// In world space, after all else.
  void scale_place(Element& element) const {
    if (find(element, "to_world") == nullptr) element.add({"transform", {{"name", "to_world"}}, {}});
    find(element, "to_world")->add({"scale", {{"value", fmt::format("{:.9g}", factor_)}}, {}});
  }
  /// Without making a camera or a lamp itself larger.
  void move_place(Element& element) const {
    for (Element& operation : find(element, "to_world")->children)
      for (const char* key : {"origin", "target"})
        if (operation.tag == "lookat") multiply_attribute(operation, key, factor_);
  }

  void scale_sensor(Element& sensor, const std::string& type) const {
    move_place(sensor);
    if (type == "orthographic")
      for (Element& operation : find(sensor, "to_world")->children)
        if (operation.tag == "scale") multiply_attribute(operation, "value", factor_);
    multiply(sensor, "near_clip", factor_, 1e-2);
    multiply(sensor, "far_clip", factor_, 1e4);
    if (type == "thinlens")
      for (const char* name : {"aperture_radius", "focus_distance"}) multiply(sensor, name, factor_);
  }

  void scale_emitter(Element& emitter, const std::string& type) const {
    if (type == "point") multiply_attribute(*find(emitter, "position"), "value", factor_);
    if (type == "spot" || type == "projector") move_place(emitter);
    const double power = factor_ * factor_;  // at as many times the distance
    if (type == "point" || type == "spot") multiply_attribute(*find(emitter, "intensity"), "value", power);
    if (type == "projector") multiply(emitter, "scale", power);
  }

  double factor_;
};

}  // namespace

void scale_scene(SceneText& scene, double factor) {
  const Scaler scaler(factor);
  for (Element& element : scene.elements) scaler.scale(element);
}

}  // namespace tachylite::test
