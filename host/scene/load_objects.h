#pragma once

// Internals of load_xml: one reader for each kind of object. Each takes a resolved element, appends to
// loader.scene, and throws InputError.

#include "scene/scene_loader.h"

namespace tachylite {

Texture load_texture(SceneLoader& loader, const XmlNode& node, TextureIndex index);
BsdfKind load_bsdf(SceneLoader& loader, const XmlNode& node);
Medium load_medium(SceneLoader& loader, const XmlNode& node);
/// A shape, or the copies that an `instance` makes of a group; `placement` acts after the shape's own
/// to_world.
void load_shape(SceneLoader& loader, const XmlNode& node, const dmat4& placement);
void load_shape_group(SceneLoader& loader, const XmlNode& node, const dmat4& placement);
/// An emitter of its own, or of the shape with that index.
void load_emitter(SceneLoader& loader, const XmlNode& node, int shape = kNone);
void load_sensor(SceneLoader& loader, const XmlNode& node);
void load_integrator(SceneLoader& loader, const XmlNode& node);

/// The decoded file, shared by all who name it; filled when deferred `finish` functions run.
/// `raw` matters for PNGs of 16 bits only, which are made linear here.
using BitmapSlot = std::shared_ptr<std::shared_ptr<const Bitmap>>;
BitmapSlot load_bitmap(SceneLoader& loader, const std::filesystem::path& file, bool raw);

}  // namespace tachylite
