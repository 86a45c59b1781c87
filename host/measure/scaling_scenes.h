#pragma once

#include <cstdint>
#include <filesystem>

namespace tachylite {

enum class MeshFormat { kPly, kObj };

/// Each writes scene.xml, and what it names, into a folder, and returns the scene's file.
/// A closed white room with a light in its ceiling holds:
/// a bumpy ball of about `triangles` triangles with vertex normals;
std::filesystem::path write_triangles_scene(const std::filesystem::path& folder, uint64_t triangles, MeshFormat format);
/// `lights` small glowing triangles (instead of the light in the ceiling), scattered through the room;
std::filesystem::path write_lights_scene(const std::filesystem::path& folder, uint64_t lights);
/// two boxes, seen with paths of so many segments, or in so many pixels a side;
std::filesystem::path write_room_scene(const std::filesystem::path& folder, int max_depth, int size);
/// balls of so many classes of material, 1 to most_material_classes().
std::filesystem::path write_materials_scene(const std::filesystem::path& folder, int classes);
int most_material_classes();

}  // namespace tachylite
