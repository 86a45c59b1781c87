#include "vulkan/device.h"

#include <algorithm>
#include <charconv>
#include <mutex>

#include "base/error.h"
#include "vulkan/buffer.h"
#include "vulkan/check.h"
#include "vulkan/instance.h"

namespace tachylite::vulkan {

struct Device::Messages {
  mutable std::mutex mutex;
  std::vector<std::string> lines;
};

namespace {

template <class Lines>
VKAPI_ATTR VkBool32 VKAPI_CALL collect(VkDebugUtilsMessageSeverityFlagBitsEXT,
                                       VkDebugUtilsMessageTypeFlagsEXT,
                                       const VkDebugUtilsMessengerCallbackDataEXT* data, void* user) {
  auto* messages = static_cast<Lines*>(user);
  std::lock_guard lock(messages->mutex);
  messages->lines.emplace_back(data->pMessage);
  return VK_FALSE;
}

/// Lower is better.
int type_rank(VkPhysicalDeviceType type) {
  switch (type) {
    case VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU:
      return 0;
    case VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU:
      return 1;
    case VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU:
      return 2;
    default:
      return 3;
  }
}

bool matches(const DeviceInfo& info, const std::string& selector) {
  uint32_t index = 0;
  const char* end = selector.data() + selector.size();
  const auto [parsed, error] = std::from_chars(selector.data(), end, index);
  if (error == std::errc() && parsed == end) return info.index == index;
  const auto equal = [](char a, char b) {
    return std::tolower(static_cast<unsigned char>(a)) == std::tolower(static_cast<unsigned char>(b));
  };
  return std::search(info.name.begin(), info.name.end(), selector.begin(), selector.end(), equal) !=
         info.name.end();
}

/// Whether the device takes pages of the host's memory as its own.
bool can_import_pages(VkPhysicalDevice physical) {
  uint32_t count = 0;
  check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, nullptr),
        "vkEnumerateDeviceExtensionProperties");
  std::vector<VkExtensionProperties> extensions(count);
  check(vkEnumerateDeviceExtensionProperties(physical, nullptr, &count, extensions.data()),
        "vkEnumerateDeviceExtensionProperties");
  if (std::none_of(extensions.begin(), extensions.end(), [](const VkExtensionProperties& e) {
        return std::string_view(e.extensionName) == VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME;
      }))
    return false;
  VkPhysicalDeviceExternalMemoryHostPropertiesEXT host{
      VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_EXTERNAL_MEMORY_HOST_PROPERTIES_EXT};
  VkPhysicalDeviceProperties2 properties{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_PROPERTIES_2, &host, {}};
  vkGetPhysicalDeviceProperties2(physical, &properties);
  return host.minImportedHostPointerAlignment <= Buffer::kPage;
}

/// The best device that the selector allows.
DeviceInfo select(const std::vector<DeviceInfo>& infos, const std::string& selector) {
  if (infos.empty()) throw RenderError("vkEnumeratePhysicalDevices found no Vulkan device");
  const DeviceInfo* best = nullptr;
  const DeviceInfo* unusable = nullptr;
  std::string names;
  for (const DeviceInfo& info : infos) {
    names += fmt::format("{}{} {}", names.empty() ? "" : ", ", info.index, info.name);
    if (!selector.empty() && !matches(info, selector)) continue;
    if (!info.unusable.empty())
      unusable = &info;
    else if (!best || type_rank(info.type) < type_rank(best->type))
      best = &info;
  }
  if (best) return *best;
  if (unusable)
    throw RenderError(fmt::format("device '{}' cannot be used: {}", unusable->name, unusable->unusable));
  throw InputError(fmt::format("no Vulkan device matches '{}'; there are: {}", selector, names));
}

}  // namespace

Device::Device(const DeviceOptions& options)
    : kept_pipelines_(options.kept_pipelines), messages_(std::make_unique<Messages>()) {
  VkDebugUtilsMessengerCreateInfoEXT messenger{VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT};
  messenger.messageSeverity =
      VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT;
  messenger.messageType = VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT;
  messenger.pfnUserCallback = collect<Messages>;
  messenger.pUserData = messages_.get();

  instance_ = create_instance(options.validation ? &messenger : nullptr);
  try {
    if (options.validation) {
      // Not volk's pointer: another instance without the extension may have cleared it.
      const auto create = reinterpret_cast<PFN_vkCreateDebugUtilsMessengerEXT>(
          vkGetInstanceProcAddr(instance_, "vkCreateDebugUtilsMessengerEXT"));
      check(create ? create(instance_, &messenger, nullptr, &messenger_) : VK_ERROR_EXTENSION_NOT_PRESENT,
            "vkCreateDebugUtilsMessengerEXT");
    }
    const std::vector<VkPhysicalDevice> physicals = physical_devices(instance_);
    std::vector<DeviceInfo> infos;
    for (VkPhysicalDevice physical : physicals)
      infos.push_back(describe_device(physical, static_cast<uint32_t>(infos.size())));
    info_ = select(infos, options.selector);
    physical_ = physicals[info_.index];
    queue_family_ = static_cast<uint32_t>(compute_queue_family(physical_));

    VkPhysicalDeviceFeatures2 available{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2};
    vkGetPhysicalDeviceFeatures2(physical_, &available);
    // Only what kernels use, where it exists; robustBufferAccess stays off.
    VkPhysicalDeviceVulkan13Features features13{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_VULKAN_1_3_FEATURES};
    features13.maintenance4 = VK_TRUE;  // local sizes by specialization constant; every 1.3 device has it
    VkPhysicalDeviceFeatures2 features{VK_STRUCTURE_TYPE_PHYSICAL_DEVICE_FEATURES_2, &features13, {}};
    info_.int64 = info_.int64 && options.int64;
    features.features.shaderInt64 = info_.int64;
    features.features.shaderFloat64 = available.features.shaderFloat64;

    const float priority = 1.0f;
    VkDeviceQueueCreateInfo queue{VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO};
    queue.queueFamilyIndex = queue_family_;
    queue.queueCount = 1;
    queue.pQueuePriorities = &priority;
    VkDeviceCreateInfo create{VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO, &features};
    create.queueCreateInfoCount = 1;
    create.pQueueCreateInfos = &queue;
    const char* const import = VK_EXT_EXTERNAL_MEMORY_HOST_EXTENSION_NAME;
    imports_host_memory_ = is_cpu() && can_import_pages(physical_);
    if (imports_host_memory_) {
      create.enabledExtensionCount = 1;
      create.ppEnabledExtensionNames = &import;
    }
    check(vkCreateDevice(physical_, &create, nullptr, &device_), "vkCreateDevice");
    vkGetDeviceQueue(device_, queue_family_, 0, &queue_);
  } catch (...) {
    destroy();
    throw;
  }
}

Device::~Device() {
  destroy();
}

void Device::destroy() {
  if (device_) {
    vkDeviceWaitIdle(device_);
    kept_pipelines_.clear();
    vkDestroyDevice(device_, nullptr);
  }
  if (messenger_) {
    const auto destroy_messenger = reinterpret_cast<PFN_vkDestroyDebugUtilsMessengerEXT>(
        vkGetInstanceProcAddr(instance_, "vkDestroyDebugUtilsMessengerEXT"));
    destroy_messenger(instance_, messenger_, nullptr);
  }
  vkDestroyInstance(instance_, nullptr);
}

std::vector<std::string> Device::validation_messages() const {
  std::lock_guard lock(messages_->mutex);
  return messages_->lines;
}

uint32_t Device::memory_type(uint32_t allowed, VkMemoryPropertyFlags required,
                             VkMemoryPropertyFlags preferred) const {
  VkPhysicalDeviceMemoryProperties memory;
  vkGetPhysicalDeviceMemoryProperties(physical_, &memory);
  for (VkMemoryPropertyFlags wanted : {required | preferred, required})
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
      if ((allowed >> i & 1u) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted) return i;
  throw RenderError(
      fmt::format("vkGetPhysicalDeviceMemoryProperties: no memory type with properties {:#x}", required));
}

}  // namespace tachylite::vulkan
