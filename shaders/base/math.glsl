// Elementary functions in float32, because drivers' own are not accurate enough: lavapipe's acos is wrong by 1.6e-4
// absolute, its log by 1e-7 absolute near 1, and fma() is not fused. Polynomials are minimax fits (Remez) of our
// own; each head says the fit's relative error. The largest relative errors measured against double on lavapipe
// stand in tests/kernels/math_test.cpp.
//
// All of them give NaN for NaN, and what C's functions give at 0, at the ends of the domain and at infinity, unless
// said otherwise. Arguments are in radians where they are angles.
#ifndef TACHYLITE_BASE_MATH_GLSL
#define TACHYLITE_BASE_MATH_GLSL

const float kPi = 3.14159265358979;
const float kTwoPi = 6.28318530717959;
const float kInvPi = 0.318309886183791;
const float kInvTwoPi = 0.159154943091895;
const float kInvFourPi = 0.0795774715459477;
const float kPiOver2 = 1.57079632679490;
const float kPiOver4 = 0.785398163397448;
const float kSqrt2 = 1.41421356237310;
const float kMaxFloat = 3.402823466e+38;
const float kEpsilon = 5.9604645e-8;  // 2^-24: half the distance from 1 to the next float; a rounding's relative error

float infinity() { return uintBitsToFloat(0x7f800000u); }
float nan() { return uintBitsToFloat(0x7fc00000u); }

// By bits: a compiler may take x != x for false.
bool is_nan(float x) { return (floatBitsToUint(x) & 0x7fffffffu) > 0x7f800000u; }
bool is_finite(float x) { return (floatBitsToUint(x) & 0x7f800000u) != 0x7f800000u; }
bool is_finite(vec3 v) { return is_finite(v.x) && is_finite(v.y) && is_finite(v.z); }

float sqr(float x) { return x * x; }
vec3 sqr(vec3 v) { return v * v; }
/// sqrt(max(x, 0)): 0 for the small negative numbers that rounding makes, and for NaN.
float safe_sqrt(float x) { return sqrt(max(x, 0.0)); }
float max_component(vec3 v) { return max(v.x, max(v.y, v.z)); }
float min_component(vec3 v) { return min(v.x, min(v.y, v.z)); }
float length_squared(vec3 v) { return dot(v, v); }

/// magnitude's absolute value with the sign bit of sign_of. By a selection: of the usual two masks and an or, followed
/// by a selection on sign_of, LLVM 15 (under Mesa 22.3.6) makes a vpternlog for AVX-512 with swapped operands.
float copy_sign(float magnitude, float sign_of) {
  return floatBitsToInt(sign_of) < 0 ? -abs(magnitude) : abs(magnitude);
}

/// a * b as an unevaluated sum x + y, exact without a fused multiply-add (Dekker 1971, "A floating-point technique
/// for extending the available precision", sec. 5) while |a|, |b| < 2^114 and the product does not underflow.
vec2 two_product(float a, float b) {
  precise const float sa = 4097.0 * a, sb = 4097.0 * b;
  precise const float ah = sa - (sa - a), bh = sb - (sb - b);
  precise const float al = a - ah, bl = b - bh;
  precise const float p = a * b;
  precise const float e = ((ah * bh - p) + ah * bl + al * bh) + al * bl;
  return vec2(p, e);
}

/// a b - c d with a relative error of about 2^-23, where the plain form may lose every digit.
float difference_of_products(float a, float b, float c, float d) {
  const vec2 ab = two_product(a, b), cd = two_product(c, d);
  precise const float difference = (ab.x - cd.x) + (ab.y - cd.y);
  return difference;
}

/// The nearest integer, |x| < 2^22: the last bit of 3 * 2^22 + x is a one's place. (round and floor are slow on lavapipe
/// 25.0.7.)
int round_to_int(float x, out float rounded) {
  precise const float shifted = x + 12582912.0;
  precise const float back = shifted - 12582912.0;
  rounded = back;
  return floatBitsToInt(shifted) - 0x4b400000;
}

// expm1(r) for |r| <= log(2) / 2; 1.8e-8.
float expm1_reduced(float r) {
  const float p =
      0.499999970 + r * (0.166665435 + r * (0.0416672006 + r * (0.00836658012 + r * 0.00138825097)));
  return r + r * r * p;
}

// x = n log(2) + r with |r| <= log(2) / 2. The first product is exact for |n| < 2^15.
float reduce_exp(float x, out int n) {
  float k;
  n = round_to_int(x * 1.44269504, k);
  precise const float r = (x - k * 0.693359375) - k * -2.12194440e-4;
  return r;
}

float exp2_of_integer(int n) { return uintBitsToFloat(uint(n + 127) << 23); }  // -126 <= n <= 127

float xexp(float x) {
  int n;
  const float r = reduce_exp(clamp(x, -104.0, 89.0), n);  // to 0 and to infinity
  const int part = n >> 1;                                // 2^n itself may be no float
  const float y = (1.0 + expm1_reduced(r)) * exp2_of_integer(part) * exp2_of_integer(n - part);
  return is_nan(x) ? x : y;
}
vec3 xexp(vec3 v) { return vec3(xexp(v.x), xexp(v.y), xexp(v.z)); }

float xexpm1(float x) {
  int n;
  const float r = reduce_exp(clamp(x, -18.0, 89.0), n);
  const float scale = exp2_of_integer(n - 1);  // half of 2^n, which may be no float
  const float y = 2.0 * (scale * expm1_reduced(r) + (scale - 0.5));
  return is_nan(x) ? x : y;
}
vec3 xexpm1(vec3 v) { return vec3(xexpm1(v.x), xexpm1(v.y), xexpm1(v.z)); }

// k log(2) + log(1 + f) for sqrt(1/2) - 1 <= f <= sqrt(2) - 1; 7.3e-9.
float log_reduced(float f, float k) {
  const float p =
      0.333333313 +
      f * (-0.250008225 +
           f * (0.200012282 +
                f * (-0.166233361 + f * (0.142017186 + f * (-0.131603643 + f * (0.127619624 + f * -0.0763448849))))));
  const float f2 = f * f;
  const float rest = (f * f2 * p + k * -2.12194440e-4) - 0.5 * f2;
  return (f + rest) + k * 0.693359375;
}

// x = 2^e m with sqrt(1/2) <= m < sqrt(2), for normal x > 0; the bits of m.
uint reduce_log(float x, out int e) {
  const uint bits = floatBitsToUint(x);
  e = int(bits - 0x3f3504f3u) >> 23;
  return bits - (uint(e) << 23);
}

float xlog(float x) {
  const bool subnormal = x < 1.17549435e-38;
  int e;
  const uint m = reduce_log(subnormal ? x * 8388608.0 : x, e);
  const float y = log_reduced(uintBitsToFloat(m) - 1.0, float(subnormal ? e - 23 : e));
  return x > 0.0 ? (x < infinity() ? y : x) : (x == 0.0 ? -infinity() : nan());
}

/// log(1 + x); the way to -log(1 - u).
float xlog1p(float x) {
  // u + c = 1 + x exactly (Dekker's fast two-sum).
  const bool large = abs(x) >= 1.0;
  precise const float u = 1.0 + x;
  precise const float c = (large ? 1.0 : x) - (u - (large ? x : 1.0));
  int e;
  const uint m = reduce_log(u, e);
  const float y = log_reduced((uintBitsToFloat(m) - 1.0) + c * uintBitsToFloat(uint(max(127 - e, 0)) << 23), float(e));
  return x > -1.0 ? (x < infinity() ? y : x) : (x == -1.0 ? -infinity() : nan());
}
vec3 xlog1p(vec3 v) { return vec3(xlog1p(v.x), xlog1p(v.y), xlog1p(v.z)); }

// asin(s) - s for 0 <= s <= 1/2, z = s^2; 9.0e-9.
float asin_rest(float s, float z) {
  const float p =
      0.166667312 + z * (0.0749566627 + z * (0.0454659276 + z * (0.0240559150 + z * 0.0425554886)));
  return s * z * p;
}

/// In [0, pi]. Arguments beyond [-1, 1], which rounding makes of a dot product, count as -1 or 1.
float xacos(float x) {
  const float a = min(abs(x), 1.0);
  const bool near_one = a > 0.5;
  const float z = near_one ? 0.5 - 0.5 * a : a * a;
  const float s = near_one ? sqrt(z) : a;
  const float rest = asin_rest(s, z);
  // acos(a) = 2 asin(sqrt((1 - a) / 2)); acos(-a) = pi - acos(a); pi/2 = 1.57079637 - 4.37113883e-8.
  const float to_one = 2.0 * (s + rest);
  precise const float to_minus_one = 3.14159274 - (to_one + 8.74227766e-8);
  precise const float right = 1.57079637 - (s + (rest + 4.37113883e-8));
  precise const float left = 1.57079637 + (s + (rest - 4.37113883e-8));
  const bool negative = x < 0.0;
  const float y = near_one ? (negative ? to_minus_one : to_one) : (negative ? left : right);
  return is_nan(x) ? x : y;
}

/// In [-pi/2, pi/2]; clamps as xacos does.
float xasin(float x) {
  const float a = min(abs(x), 1.0);
  const bool near_one = a > 0.5;
  const float z = near_one ? 0.5 - 0.5 * a : a * a;
  const float s = near_one ? sqrt(z) : a;
  const float rest = asin_rest(s, z);
  precise const float far = 1.57079637 - (2.0 * (s + rest) + 4.37113883e-8);
  return is_nan(x) ? x : copy_sign(near_one ? far : s + rest, x);
}

/// The angle of the point (x, y) in [-pi, pi]; C's signs at zeros. Coordinates beyond 1.7e38 count as that.
float xatan2(float y, float x) {
  const float ax = min(abs(x), 1.7e38), ay = min(abs(y), 1.7e38);
  const float lo = min(ax, ay), hi = max(ax, ay);
  // atan(lo / hi) = pi/4 + atan((lo - hi) / (lo + hi)); so |t| <= tan(pi / 8).
  const bool turn = lo > 0.414213562 * hi;
  const float numerator = turn ? lo - hi : lo;
  const float denominator = turn ? lo + hi : hi;
  const float t = numerator / (denominator == 0.0 ? 1.0 : denominator);
  const float z = t * t;
  // atan(t); 1.9e-9
  const float p = -0.333333194 + z * (0.199985325 + z * (-0.142429560 + z * (0.105813734 + z * -0.0603294931)));
  float angle = t + t * z * p;
  // Unfold the octants: multiples of pi/4 = 0.785398006 + 1.56958e-7, whose first part has bits to spare.
  float k = turn ? 1.0 : 0.0;
  if (ay > ax) {
    k = 2.0 - k;
    angle = -angle;
  }
  if ((floatBitsToUint(x) & 0x80000000u) != 0u) {
    k = 4.0 - k;
    angle = -angle;
  }
  precise const float unfolded = k * 0.785398006 + (k * 1.56958239e-7 + angle);
  return is_nan(x) || is_nan(y) ? nan() : copy_sign(unfolded, y);
}

/// (cos, sin) of 2 pi turns, |turns| <= 1/8, without a branch; 1.0e-8 and 4.2e-8.
vec2 cos_sin_eighth(float turns) {
  const float z = turns * turns;
  const float c = 1.0 + z * (-19.7392082 + z * (64.9393234 + z * (-85.4432145 + z * 59.2192383)));
  const float s = turns * (6.28318548 + z * (-41.3416595 + z * (81.5923309 + z * -75.3922501)));
  return vec2(c, s);
}

/// (cos, sin) of 2 pi turns, |turns| < 2^20; exact multiples of 1/4 give exact zeros and ones. The way to the
/// direction of an azimuth 2 pi u.
vec2 cos_sin_turns(float turns) {
  float quarter;
  const int q = round_to_int(4.0 * turns, quarter);
  const vec2 a = cos_sin_eighth(turns - 0.25 * quarter);
  const vec2 b = (q & 1) == 0 ? a : vec2(-a.y, a.x);
  return (q & 2) == 0 ? b : -b;
}

/// The error function, 2 / sqrt(pi) integral_0^x exp(-t^2) dt.
float xerf(float x) {
  const float a = min(abs(x), 4.0);  // erf(4) rounds to 1
  const float z = a * a;
  // erf(a) / a - 1, a <= 0.92; 9.2e-9
  const float p =
      0.128379166 +
      z * (-0.376126349 +
           z * (0.112836957 + z * (-0.0268593933 + z * (0.00520102168 + z * (-0.000814258121 + z * 8.36957915e-05)))));
  // log(erfc(a)), 0.92 <= a <= 4; 3.9e-10 of erf
  const float q =
      0.000174683169 +
      a * (-1.12951493 +
           a * (-0.633346915 +
                a * (-0.108280070 +
                     a * (0.0251194164 + a * (-0.00417105854 + a * (0.000434461661 + a * -2.10949620e-05))))));
  const float y = a < 0.92 ? a + a * p : 1.0 - xexp(q);
  return is_nan(x) ? x : copy_sign(y, x);
}

/// The inverse of erf, by polynomials in log(1 - x^2): Giles 2010, "Approximating the erfinv function", with fits of
/// our own (7.9e-8 and 1.2e-7). +-infinity at +-1, NaN beyond.
float xerfinv(float x) {
  const float w = -xlog((1.0 - x) * (1.0 + x));
  const float c = w - 2.5, t = sqrt(max(w, 0.0)) - 3.0;
  const float centre =
      1.50140941 +
      c * (0.246640280 +
           c * (-0.00417738687 +
                c * (-0.00125274190 +
                     c * (0.000218344445 +
                          c * (-4.96334496e-06 +
                               c * (-3.46270440e-06 +
                                    c * (4.66170064e-07 + c * (2.32326212e-08 + c * -8.79101414e-09))))))));
  const float tail =
      2.83297682 +
      t * (1.00167406 +
           t * (0.00943808258 +
                t * (-0.00762233092 +
                     t * (0.00574541138 +
                          t * (-0.00367247243 + t * (0.00133585278 + t * (9.90706903e-05 + t * -0.000190654420)))))));
  const float y = x * (w < 5.0 ? centre : tail);
  return abs(x) < 1.0 ? y : (abs(x) == 1.0 ? x * infinity() : nan());
}

#endif
