// Queue lengths, indirect dispatch arguments and counts of a wave, as words of kBindCounters. The queues themselves
// lie in kBindQueues: queue q begins at q * capacity.
//
// Only tracing and sample_medium append to queues, with an atomic each. What shading makes of an entry, the next ray and
// the shadow ray, has a place that follows from the entry's, so that shading has no atomics, which are slow where many
// cores want the same: entry i of queue q fills place kCounterPlace[q] + i, with kNoPath where there is no ray.
#ifndef TACHYLITE_SHARED_COUNTERS_H
#define TACHYLITE_SHARED_COUNTERS_H
#include "interop.h"
TACHYLITE_SHARED_BEGIN

// Queues of path slots.
TACHYLITE_CONST uint kQueueRays0 = 0u;     // rays of even bounces; kNoPath in unused places
TACHYLITE_CONST uint kQueueRays1 = 1u;     // rays of odd bounces; the same
TACHYLITE_CONST uint kQueueShadow = 2u;    // shadow rays; the same
TACHYLITE_CONST uint kQueueEmitter = 3u;   // hits on area lights
TACHYLITE_CONST uint kQueueEscaped = 4u;   // rays that left the scene, if it has an environment
TACHYLITE_CONST uint kQueueSurface = 5u;   // first of one queue a material class
TACHYLITE_CONST uint kMaxClasses = 255u;    // as many as an entry of 8 bits tells apart (kClassNone)
// After them, at kQueueSurface + number of classes: collisions in media, where there are any.
TACHYLITE_CONST uint kMaxQueues = kQueueSurface + kMaxClasses + 1u;
TACHYLITE_CONST uint kNoPath = 0xffffffffu;

// Words of the counters buffer.
TACHYLITE_CONST uint kCounterQueue = 0u;                        // length of each queue, or its number of places; from
                                                               // kQueueEmitter on of even bounces, the next kMaxQueues
                                                               // words of odd ones
TACHYLITE_CONST uint kCounterPlace = 2u * kMaxQueues;           // first place of each queue that is shaded
TACHYLITE_CONST uint kCounterClosestTotal = 3u * kMaxQueues;    // rays traced since the host last reset them
TACHYLITE_CONST uint kCounterShadowTotal = 3u * kMaxQueues + 1u;
TACHYLITE_CONST uint kCounterNonfinite = 3u * kMaxQueues + 2u;  // contributions dropped: NaN or infinite
TACHYLITE_CONST uint kCounterOverflow = 3u * kMaxQueues + 3u;   // stacks or queues that were full
TACHYLITE_CONST uint kCounterUnfinished = 3u * kMaxQueues + 4u; // lanes whose loops the driver has ended too early
TACHYLITE_CONST uint kCounterCaustics = 3u * kMaxQueues + 5u;   // flux of photons on guided surfaces straight from a
                                                               // focused lobe, in units of 1 / kCausticUnit (shared/guide.h)
TACHYLITE_CONST uint kCounterArguments = 3u * kMaxQueues + 6u;       // (x, y, z) of each dispatch below, 4 words apart

// Indirect dispatches.
TACHYLITE_CONST uint kDispatchClosest = 0u;
TACHYLITE_CONST uint kDispatchShadow = 1u;
TACHYLITE_CONST uint kDispatchQueue = 2u;                       // + queue: one lane an entry; of rays: sample_medium
TACHYLITE_CONST uint kCounterWords = kCounterArguments + 4u * (kDispatchQueue + kMaxQueues);

TACHYLITE_CONST uint kWorkgroupSize = 64u;

// Modes of prepare_dispatch.
TACHYLITE_CONST uint kPrepareFirst = 0u;   // after the first rays were queued: sizes intersect_primary
TACHYLITE_CONST uint kPrepareShade = 1u;   // after sorting: sizes the shading stages and the tracing that follows
TACHYLITE_CONST uint kPrepareShadow = 2u;  // after shade_segment: sizes intersect_shadow alone

TACHYLITE_SHARED_END
#endif
