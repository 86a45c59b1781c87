#include "vulkan/instance.h"

#include <algorithm>
#include <cstdio>
#include <cstring>
#include <mutex>

#include "base/error.h"
#include "vulkan/check.h"

namespace tachylite::vulkan {
namespace {

constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";

bool has_validation_layer() {
  uint32_t count = 0;
  check(vkEnumerateInstanceLayerProperties(&count, nullptr), "vkEnumerateInstanceLayerProperties");
  std::vector<VkLayerProperties> layers(count);
  check(vkEnumerateInstanceLayerProperties(&count, layers.data()), "vkEnumerateInstanceLayerProperties");
  return std::any_of(layers.begin(), layers.end(), [](const VkLayerProperties& layer) {
    return std::strcmp(layer.layerName, kValidationLayer) == 0;
  });
}

void load_vulkan() {
  static std::mutex mutex;
  std::lock_guard lock(mutex);
  if (volkGetInstanceVersion() != 0) return;
  if (volkInitialize() != VK_SUCCESS)
    throw RenderError("volkInitialize failed: no Vulkan loader (libvulkan.so.1) on this machine");
}

}  // namespace

VkInstance create_instance(const VkDebugUtilsMessengerCreateInfoEXT* messenger) {
  load_vulkan();
  if (volkGetInstanceVersion() < VK_API_VERSION_1_3)
    throw RenderError("the Vulkan loader is older than Vulkan 1.3");

  VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
  application.pApplicationName = "tachylite";
  application.apiVersion = VK_API_VERSION_1_3;
  VkInstanceCreateInfo create{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
  create.pApplicationInfo = &application;

  const char* extensions[] = {VK_EXT_DEBUG_UTILS_EXTENSION_NAME, VK_EXT_VALIDATION_FEATURES_EXTENSION_NAME};
  const VkValidationFeatureEnableEXT enabled = VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT;
  VkValidationFeaturesEXT features{VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT};
  features.enabledValidationFeatureCount = 1;
  features.pEnabledValidationFeatures = &enabled;
  if (messenger) {
    if (!has_validation_layer())
      throw RenderError(fmt::format("vkCreateInstance: validation was asked for, but {} is not installed",
                                    kValidationLayer));
    create.enabledLayerCount = 1;
    create.ppEnabledLayerNames = &kValidationLayer;
    create.enabledExtensionCount = 2;
    create.ppEnabledExtensionNames = extensions;
    features.pNext = messenger;
    create.pNext = &features;
  }
  VkInstance instance = VK_NULL_HANDLE;
  const VkResult result = vkCreateInstance(&create, nullptr, &instance);
  if (result == VK_ERROR_INCOMPATIBLE_DRIVER)
    throw RenderError("vkCreateInstance failed: no Vulkan driver on this machine");
  check(result, "vkCreateInstance");
  // Instance-level pointers go through the loader and so serve every device of every instance.
  volkLoadInstance(instance);
  return instance;
}

std::vector<VkPhysicalDevice> physical_devices(VkInstance instance) {
  uint32_t count = 0;
  check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
  std::vector<VkPhysicalDevice> devices(count);
  if (count)
    check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
  return devices;
}

int compute_queue_family(VkPhysicalDevice physical) {
  uint32_t count = 0;
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
  std::vector<VkQueueFamilyProperties> families(count);
  vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
  int found = -1;
  for (int i = static_cast<int>(count) - 1; i >= 0; --i) {
    const VkQueueFamilyProperties& family = families[static_cast<size_t>(i)];
    if (!(family.queueFlags & VK_QUEUE_COMPUTE_BIT)) continue;
    const bool found_has_timestamps =
        found >= 0 && families[static_cast<size_t>(found)].timestampValidBits > 0;
    if (family.timestampValidBits > 0 || !found_has_timestamps) found = i;
  }
  return found;
}

namespace {

// Mesa 25's llvmpipe calls fetches through a pointer, 22.3.6 does not (tests/bench/README.md); of others nothing is known.
bool has_slow_texel_fetches(const DeviceInfo& info) {
  unsigned major = 0;
  return info.driver == "llvmpipe" && std::sscanf(info.driver_version.c_str(), "Mesa %u", &major) == 1 && major >= 25;
}

std::string missing_feature(VkPhysicalDevice physical, const VkPhysicalDeviceProperties& properties,
                            const VkPhysicalDeviceVulkan11Properties& properties11) {
  if (properties.apiVersion < VK_API_VERSION_1_3) return "Vulkan 1.3 is needed";
  if (compute_queue_family(physical) < 0) return "it has no compute queue";
  if (!(properties11.subgroupSupportedStages & VK_SHADER_STAGE_COMPUTE_BIT))
    return "it has no subgroup operations in compute kernels";
  const VkSubgroupFeatureFlags needed = VK_SUBGROUP_FEATURE_BASIC_BIT | VK_SUBGROUP_FEATURE_VOTE_BIT |
                                        VK_SUBGROUP_FEATURE_BALLOT_BIT | VK_SUBGROUP_FEATURE_ARITHMETIC_BIT |
                                        VK_SUBGROUP_FEATURE_SHUFFLE_BIT;
  if ((properties11.subgroupSupportedOperations & needed) != needed)
    return "it lacks basic, vote, ballot, arithmetic or shuffle subgroup operations";
  return {};
}

}  // namespace

DeviceInfo describe_device(VkPhysicalDevice physical, uint32_t index) {
  VkPhysicalDeviceDriverProperties driver{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_DRIVER_PROPERTIES};
  VkPhysicalDeviceVulkan11Properties properties11{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_1_PROPERTIES};
  VkPhysicalDeviceProperties2 properties2{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2};
  vkGetPhysicalDeviceProperties(physical, &properties2.properties);
  const VkPhysicalDeviceProperties& properties = properties2.properties;
  if (properties.apiVersion >= VK_API_VERSION_1_2) {
    properties2.pNext = &properties11;
    properties11.pNext = &driver;
    vkGetPhysicalDeviceProperties2(physical, &properties2);
  }
  DeviceInfo info;
  info.index = index;
  info.name = properties.deviceName;
  info.driver = driver.driverName;
  info.driver_version = driver.driverInfo;
  info.api_version =
      fmt::format("{}.{}.{}", VK_API_VERSION_MAJOR(properties.apiVersion),
                  VK_API_VERSION_MINOR(properties.apiVersion), VK_API_VERSION_PATCH(properties.apiVersion));
  info.type = properties.deviceType;
  info.subgroup_size = properties11.subgroupSize;
  VkPhysicalDeviceFeatures features;
  vkGetPhysicalDeviceFeatures(physical, &features);
  info.int64 = features.shaderInt64;
  info.slow_texel_fetches = has_slow_texel_fetches(info);
  info.max_workgroup_invocations = properties.limits.maxComputeWorkGroupInvocations;
  info.max_workgroup_count_x = properties.limits.maxComputeWorkGroupCount[0];
  info.max_storage_buffer_range = properties.limits.maxStorageBufferRange;
  info.max_texel_buffer_elements = properties.limits.maxTexelBufferElements;
  info.max_uniform_buffer_range = properties.limits.maxUniformBufferRange;
  info.max_push_constants = properties.limits.maxPushConstantsSize;

  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical, &memory);
  for (uint32_t i = 0; i < memory.memoryHeapCount; ++i)
    if (memory.memoryHeaps[i].flags & VK_MEMORY_HEAP_DEVICE_LOCAL_BIT)
      info.device_memory = std::max<uint64_t>(info.device_memory, memory.memoryHeaps[i].size);

  const int family = compute_queue_family(physical);
  if (family >= 0) {
    uint32_t count = 0;
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, nullptr);
    std::vector<VkQueueFamilyProperties> families(count);
    vkGetPhysicalDeviceQueueFamilyProperties(physical, &count, families.data());
    if (families[static_cast<size_t>(family)].timestampValidBits > 0)
      info.timestamp_period_ns = static_cast<double>(properties.limits.timestampPeriod);
  }
  info.unusable = missing_feature(physical, properties, properties11);
  return info;
}

std::vector<DeviceInfo> list_devices() {
  VkInstance instance = create_instance(nullptr);
  std::vector<DeviceInfo> infos;
  for (VkPhysicalDevice physical : physical_devices(instance))
    infos.push_back(describe_device(physical, static_cast<uint32_t>(infos.size())));
  vkDestroyInstance(instance, nullptr);
  return infos;
}

}  // namespace tachylite::vulkan
