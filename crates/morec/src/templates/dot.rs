//! Sums of products of 16-bit numbers, by the instructions that processors have for them.
//!
//! The only `unsafe` code of this crate: compilers do not choose these instructions by themselves, and they make matching twice as
//! fast. Sums are modulo 2³², so every choice gives the same numbers; each is tested against [`plain`].

#![allow(unsafe_code)]

/// Cells or exemplars that are worked on at once, kept in registers while the coordinates go by: four of AVX-512, eight
/// of AVX2, sixteen of SSE2 and NEON. Memory is then read once and in order, which is what bounds the time.
pub const LANES: usize = 64;

/// Two coordinates that follow each other.
pub type Pair = [i16; 2];

/// Of [`LANES`] rows; no load of 64 bytes lies across two cache lines.
#[derive(Debug, Clone, Copy)]
#[repr(align(64))]
pub struct Pairs(pub [Pair; LANES]);

/// Rows of a stream that are taken together: templates come from memory once for all of them.
pub const AT_ONCE: usize = 16;

/// Rows of a stream whose sums are kept in registers together.
#[allow(dead_code, reason = "not on every processor")]
const IN_REGISTERS: usize = 4;

/// `out[lane] = Σ_k rows[k].0[lane] · z[k]` for each row `z` of a stream and its `out`, at most [`AT_ONCE`]; a `z` has as many pairs as
/// there are `rows`.
pub type PairProducts = fn(rows: &[Pairs], stream: &[&[Pair]], out: &mut [[i32; LANES]]);

/// What is fastest on this processor.
pub fn fastest() -> PairProducts {
    choices().next().unwrap_or(plain)
}

/// All that this processor has besides [`plain`], the fastest first.
fn choices() -> impl Iterator<Item = PairProducts> {
    #[cfg(target_arch = "x86_64")]
    let choices = {
        let wide = is_x86_feature_detected!("avx512f") && is_x86_feature_detected!("avx512bw");
        [
            (
                wide && is_x86_feature_detected!("avx512vnni"),
                x86::vnni as PairProducts,
            ),
            (wide, x86::avx512),
            (is_x86_feature_detected!("avx2"), x86::avx2),
            (true, x86::sse2),
        ]
    };
    #[cfg(target_arch = "aarch64")]
    let choices = [(true, neon::neon as PairProducts)];
    #[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
    let choices = [(true, wasm::simd128 as PairProducts)];
    #[cfg(not(any(
        target_arch = "x86_64",
        target_arch = "aarch64",
        all(target_arch = "wasm32", target_feature = "simd128")
    )))]
    let choices: [(bool, PairProducts); 0] = [];
    let here = choices.into_iter().filter(|(is_here, _)| *is_here);
    here.map(|(_, dots)| dots)
}

/// One product after the other.
fn plain(rows: &[Pairs], stream: &[&[Pair]], out: &mut [[i32; LANES]]) {
    for (z, out) in stream.iter().zip(out) {
        out.fill(0);
        for (pairs, z) in rows.iter().zip(*z) {
            let [a, b] = z.map(i32::from);
            for (sum, pair) in out.iter_mut().zip(&pairs.0) {
                let [left, right] = pair.map(i32::from);
                *sum = sum.wrapping_add((left * a).wrapping_add(right * b));
            }
        }
    }
}

/// Sums side by side, in a register or two.
#[allow(dead_code, reason = "not on every processor")]
trait LaneSums: Copy {
    /// How many.
    const WIDE: usize;
    /// The pairs of as many rows.
    type Row: Copy;

    /// All 0.
    ///
    /// # Safety
    /// The processor has the instructions; this holds for all functions here.
    unsafe fn zero() -> Self;

    /// # Safety
    /// [`WIDE`](Self::WIDE) pairs can be read.
    unsafe fn load(pairs: *const Pair) -> Self::Row;

    /// Adds the products with `z`.
    ///
    /// # Safety
    /// As [`zero`](Self::zero).
    unsafe fn add(self, row: Self::Row, z: Pair) -> Self;

    /// # Safety
    /// [`WIDE`](Self::WIDE) sums can be written.
    unsafe fn store(self, out: *mut i32);
}

/// The pair as one number, as it lies in memory.
#[allow(dead_code, reason = "not on every processor")]
fn both(z: Pair) -> i32 {
    i32::from(z[0] as u16) | i32::from(z[1]) << 16
}

/// [`PairProducts`] of `N` rows of a stream, `GROUPS` registers of sums for each at a time.
///
/// # Safety
/// The processor has the instructions of `S`; the function is inlined into one that is compiled for them.
#[allow(dead_code, reason = "not on every processor")]
#[inline(always)]
unsafe fn sums_of<S: LaneSums, const N: usize, const GROUPS: usize>(
    rows: &[Pairs],
    stream: &[&[Pair]; N],
    out: &mut [[i32; LANES]; N],
) {
    const { assert!(LANES.is_multiple_of(S::WIDE * GROUPS)) };
    let stream = stream.map(|z| &z[..rows.len()]);
    for from in (0..LANES).step_by(S::WIDE * GROUPS) {
        // SAFETY: `from + group * WIDE + WIDE` is at most LANES, the length of `pairs` and `out`.
        unsafe {
            let mut sums = [[S::zero(); GROUPS]; N];
            for (k, pairs) in rows.iter().enumerate() {
                for group in 0..GROUPS {
                    let row = S::load(pairs.0.as_ptr().add(from + group * S::WIDE));
                    for n in 0..N {
                        sums[n][group] = sums[n][group].add(row, stream[n][k]);
                    }
                }
            }
            for n in 0..N {
                for group in 0..GROUPS {
                    sums[n][group].store(out[n].as_mut_ptr().add(from + group * S::WIDE));
                }
            }
        }
    }
}

/// The function `$name` of the type [`PairProducts`], compiled for the instructions `$features`, with sums of the type `$sums`: `$one` of
/// them are kept in registers for a single row, `$all` for each of [`IN_REGISTERS`].
#[allow(unused_macros, reason = "not on every processor")]
macro_rules! dots {
    ($name:ident, $features:literal, $sums:ty, $one:literal, $all:literal) => {
        pub fn $name(rows: &[Pairs], stream: &[&[Pair]], out: &mut [[i32; LANES]]) {
            #[target_feature(enable = $features)]
            fn compiled(rows: &[Pairs], stream: &[&[Pair]], out: &mut [[i32; LANES]]) {
                let (four, rest) = stream.as_chunks::<IN_REGISTERS>();
                let (out_of_four, out_of_rest) = out.as_chunks_mut();
                // SAFETY: this function is compiled for the instructions, and so runs only where they are.
                unsafe {
                    for (stream, out) in four.iter().zip(out_of_four) {
                        sums_of::<$sums, IN_REGISTERS, $all>(rows, stream, out);
                    }
                    for (z, out) in rest.iter().zip(out_of_rest) {
                        sums_of::<$sums, 1, $one>(rows, &[z], std::array::from_mut(out));
                    }
                }
            }
            // SAFETY: `choices` offers it only where the processor has them. WebAssembly has them or does not load.
            #[allow(unused_unsafe)]
            unsafe {
                compiled(rows, stream, out);
            }
        }
    };
}

#[cfg(target_arch = "x86_64")]
mod x86 {
    use std::arch::x86_64::*;

    use super::{IN_REGISTERS, LANES, LaneSums, Pair, Pairs, both, sums_of};

    #[derive(Clone, Copy)]
    struct Vnni(__m512i);

    impl LaneSums for Vnni {
        const WIDE: usize = 16;
        type Row = __m512i;

        #[inline(always)]
        unsafe fn zero() -> Self {
            unsafe { Self(_mm512_setzero_si512()) }
        }
        #[inline(always)]
        unsafe fn load(pairs: *const Pair) -> __m512i {
            unsafe { _mm512_loadu_si512(pairs.cast()) }
        }
        #[inline(always)]
        unsafe fn add(self, row: __m512i, z: Pair) -> Self {
            unsafe { Self(_mm512_dpwssd_epi32(self.0, row, _mm512_set1_epi32(both(z)))) }
        }
        #[inline(always)]
        unsafe fn store(self, out: *mut i32) {
            unsafe { _mm512_storeu_si512(out.cast(), self.0) }
        }
    }

    /// Sums by an instruction that multiplies and adds neighbours, and another that adds.
    macro_rules! by_neighbours {
        ($name:ident, $register:ty, $wide:literal, $zero:ident, $load:ident, $madd:ident, $add:ident, $splat:ident, $store:ident) => {
            #[derive(Clone, Copy)]
            struct $name($register);

            impl LaneSums for $name {
                const WIDE: usize = $wide;
                type Row = $register;

                #[inline(always)]
                unsafe fn zero() -> Self {
                    unsafe { Self($zero()) }
                }
                #[inline(always)]
                unsafe fn load(pairs: *const Pair) -> $register {
                    unsafe { $load(pairs.cast()) }
                }
                #[inline(always)]
                unsafe fn add(self, row: $register, z: Pair) -> Self {
                    unsafe { Self($add(self.0, $madd(row, $splat(both(z))))) }
                }
                #[inline(always)]
                unsafe fn store(self, out: *mut i32) {
                    unsafe { $store(out.cast(), self.0) }
                }
            }
        };
    }

    by_neighbours!(
        Wide,
        __m512i,
        16,
        _mm512_setzero_si512,
        _mm512_loadu_si512,
        _mm512_madd_epi16,
        _mm512_add_epi32,
        _mm512_set1_epi32,
        _mm512_storeu_si512
    );
    by_neighbours!(
        Avx2,
        __m256i,
        8,
        _mm256_setzero_si256,
        _mm256_loadu_si256,
        _mm256_madd_epi16,
        _mm256_add_epi32,
        _mm256_set1_epi32,
        _mm256_storeu_si256
    );
    by_neighbours!(
        Sse2,
        __m128i,
        4,
        _mm_setzero_si128,
        _mm_loadu_si128,
        _mm_madd_epi16,
        _mm_add_epi32,
        _mm_set1_epi32,
        _mm_storeu_si128
    );

    dots!(vnni, "avx512f,avx512bw,avx512vnni", Vnni, 4, 4);
    dots!(avx512, "avx512f,avx512bw", Wide, 4, 4);
    dots!(avx2, "avx2", Avx2, 8, 2);
    dots!(sse2, "sse2", Sse2, 8, 2);
}

#[cfg(target_arch = "aarch64")]
mod neon {
    use std::arch::aarch64::*;

    use super::{IN_REGISTERS, LANES, LaneSums, Pair, Pairs, sums_of};

    #[derive(Clone, Copy)]
    struct Neon(int32x4_t, int32x4_t);

    impl LaneSums for Neon {
        const WIDE: usize = 8;
        type Row = int16x8x2_t;

        #[inline(always)]
        unsafe fn zero() -> Self {
            unsafe { Self(vdupq_n_s32(0), vdupq_n_s32(0)) }
        }
        #[inline(always)]
        unsafe fn load(pairs: *const Pair) -> int16x8x2_t {
            unsafe { vld2q_s16(pairs.cast()) }
        }
        #[inline(always)]
        unsafe fn add(self, row: int16x8x2_t, [a, b]: Pair) -> Self {
            unsafe {
                let low = vmlal_n_s16(self.0, vget_low_s16(row.0), a);
                let high = vmlal_high_n_s16(self.1, row.0, a);
                Self(
                    vmlal_n_s16(low, vget_low_s16(row.1), b),
                    vmlal_high_n_s16(high, row.1, b),
                )
            }
        }
        #[inline(always)]
        unsafe fn store(self, out: *mut i32) {
            unsafe {
                vst1q_s32(out, self.0);
                vst1q_s32(out.add(4), self.1);
            }
        }
    }

    dots!(neon, "neon", Neon, 8, 2);
}

#[cfg(all(target_arch = "wasm32", target_feature = "simd128"))]
mod wasm {
    use std::arch::wasm32::*;

    use super::{IN_REGISTERS, LANES, LaneSums, Pair, Pairs, both, sums_of};

    #[derive(Clone, Copy)]
    struct Simd(v128);

    impl LaneSums for Simd {
        const WIDE: usize = 4;
        type Row = v128;

        #[inline(always)]
        unsafe fn zero() -> Self {
            Self(i32x4_splat(0))
        }
        #[inline(always)]
        unsafe fn load(pairs: *const Pair) -> v128 {
            unsafe { v128_load(pairs.cast()) }
        }
        #[inline(always)]
        unsafe fn add(self, row: v128, z: Pair) -> Self {
            let z = i32x4_splat(both(z));
            Self(i32x4_add(self.0, i32x4_dot_i16x8(row, z)))
        }
        #[inline(always)]
        unsafe fn store(self, out: *mut i32) {
            unsafe { v128_store(out.cast(), self.0) }
        }
    }

    dots!(simd128, "simd128", Simd, 8, 2);
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// The extremes now and then.
    fn number() -> impl Strategy<Value = i16> {
        prop_oneof![any::<i16>(), Just(i16::MAX), Just(-i16::MAX)]
    }

    proptest! {
        #[test]
        fn all_choices_give_the_same_sums(
            (pairs, rows, stream) in (1usize..40).prop_flat_map(|pairs| {
                let numbers = move |count: usize| prop::collection::vec([number(), number()], count * pairs);
                (Just(pairs), numbers(LANES), (1..=AT_ONCE).prop_flat_map(numbers))
            }),
        ) {
            let rows: Vec<Pairs> = rows.as_chunks().0.iter().map(|pairs| Pairs(*pairs)).collect();
            let stream: Vec<&[Pair]> = stream.chunks_exact(pairs).collect();
            let sums = |dots: PairProducts| {
                let mut out = vec![[7; LANES]; stream.len()];
                dots(&rows, &stream, &mut out);
                out
            };
            for dots in choices() {
                prop_assert_eq!(sums(dots), sums(plain));
            }
        }
    }
}
