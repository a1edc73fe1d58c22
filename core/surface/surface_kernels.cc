#include "core/surface/surface_kernels.h"

#include "core/spline/basis.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "core/surface/surface_kernels.cc"
#include "hwy/foreach_target.h"
//
#include "core/noise/noise-inl.h"
#include "hwy/highway.h"

HWY_BEFORE_NAMESPACE();
namespace terrane::core {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using DF = hn::ScalableTag<float>;
using DU = hn::RebindToUnsigned<DF>;
using DI = hn::RebindToSigned<DF>;
using VF = hn::Vec<DF>;
using VU = hn::Vec<DU>;

// No MulAdd here: targets with and without FMA must round alike.
HWY_INLINE VF AddProduct(VF sum, VF a, VF b) {
  return hn::Add(sum, hn::Mul(a, b));
}

// 16 random bits as a number; they fit into the signed conversion.
HWY_INLINE VF LowHalf(VU bits) {
  const DF df;
  return hn::ConvertTo(
      df, hn::BitCast(DI(), hn::And(bits, hn::Set(DU(), 0xFFFFu))));
}

HWY_INLINE VF HighHalf(VU bits) {
  const DF df;
  return hn::ConvertTo(df, hn::BitCast(DI(), hn::ShiftRight<16>(bits)));
}

// Adds the draws of one pair to its two weights and their readouts.
HWY_INLINE void AddDraws(const InputPair& pair, const DrawnPair* drawn,
                         VU words, VF& weight0, VF& weight1, VF& readout0,
                         VF& readout1) {
  const DF df;
  for (int k = pair.drawn_begin; k < pair.drawn_end; ++k) {
    const DrawnPair& draw = drawn[k];
    const VU bits = HashLanes(DU(), words, draw.key);
    const VF low = LowHalf(bits);
    const VF high = HighHalf(bits);
    weight0 = AddProduct(weight0, low, hn::Set(df, draw.weight[0]));
    weight1 = AddProduct(weight1, high, hn::Set(df, draw.weight[1]));
    readout0 = AddProduct(readout0, low, hn::Set(df, draw.readout[0]));
    readout1 = AddProduct(readout1, high, hn::Set(df, draw.readout[1]));
  }
}

// The same where no readout is folded in.
HWY_INLINE void AddDraws(const InputPair& pair, const DrawnPair* drawn,
                         VU words, VF& weight0, VF& weight1) {
  const DF df;
  for (int k = pair.drawn_begin; k < pair.drawn_end; ++k) {
    const DrawnPair& draw = drawn[k];
    const VU bits = HashLanes(DU(), words, draw.key);
    weight0 = AddProduct(weight0, LowHalf(bits), hn::Set(df, draw.weight[0]));
    weight1 = AddProduct(weight1, HighHalf(bits), hn::Set(df, draw.weight[1]));
  }
}

HWY_INLINE VF Desired(const DesiredResponse& desired, VU words) {
  const DF df;
  const VF constant = hn::Set(df, desired.constant);
  if (desired.random == 0) return constant;
  const VF draw = LowHalf(HashLanes(DU(), words, desired.key));
  return AddProduct(constant, draw, hn::Set(df, desired.random));
}

// Adds one input to the three sums of a network that is read out linearly.
HWY_INLINE void AddInput(VF x, VF weight, VF readout, VF squared, VF& sum,
                         VF& read, VF& squares) {
  sum = AddProduct(sum, x, weight);
  read = AddProduct(read, x, readout);
  squares = AddProduct(squares, hn::Mul(x, x), squared);
}

// M h from the three sums (adaline.h).
HWY_INLINE VF Trained(const ColumnRun& run, int c,
                      const DesiredResponse& desired, VU words, VF sum, VF read,
                      VF squares) {
  const VF error = hn::Sub(Desired(desired, words), sum);
  const VF step = hn::Mul(error, hn::LoadU(DF(), run.gains + c));
  return AddProduct(read, step, squares);
}

void OneNetworkHeights(const ColumnRun& run, const OneNetworkRow& row,
                       float* out) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  for (int c = 0; c < run.count; c += lanes) {
    const VU words = hn::LoadU(DU(), run.words + c);
    VF sum = hn::Zero(df);
    VF read = hn::Zero(df);
    VF squares = hn::Zero(df);
    const float* input = run.inputs + c;
    for (int p = 0; p < run.pairs; ++p, input += 2 * run.stride) {
      const InputPair& pair = row.pairs[p];
      VF weight0 = hn::Set(df, pair.weight[0]);
      VF weight1 = hn::Set(df, pair.weight[1]);
      VF readout0 = hn::Set(df, pair.readout[0]);
      VF readout1 = hn::Set(df, pair.readout[1]);
      AddDraws(pair, row.drawn, words, weight0, weight1, readout0, readout1);
      AddInput(hn::LoadU(df, input), weight0, readout0,
               hn::Set(df, pair.squared[0]), sum, read, squares);
      AddInput(hn::LoadU(df, input + run.stride), weight1, readout1,
               hn::Set(df, pair.squared[1]), sum, read, squares);
    }
    hn::StoreU(Trained(run, c, row.desired, words, sum, read, squares), df,
               out + c);
  }
}

// The trained products f_j w_j of the network along u, a vector each.
HWY_INLINE void TrainAlongU(const TwoNetworksRow& row, VU words,
                            float* trained) {
  const DF df;
  const std::size_t lanes = hn::Lanes(df);
  const OneNetworkRow& network = row.along_u;
  VF sum = hn::Zero(df);
  for (int p = 0; p < row.pairs_u; ++p) {
    const InputPair& pair = network.pairs[p];
    VF weight0 = hn::Set(df, pair.weight[0]);
    VF weight1 = hn::Set(df, pair.weight[1]);
    AddDraws(pair, network.drawn, words, weight0, weight1);
    sum = hn::Add(hn::Add(sum, weight0), weight1);
    float* const store = trained + 2 * static_cast<std::size_t>(p) * lanes;
    hn::StoreU(weight0, df, store);
    hn::StoreU(weight1, df, store + lanes);
  }
  const VF error = hn::Sub(Desired(network.desired, words), sum);
  const VF step = hn::Mul(error, hn::Set(df, row.gain_u));
  for (int p = 0; p < row.pairs_u; ++p) {
    for (const float squared : network.pairs[p].squared) {
      const VF weight = hn::LoadU(df, trained);
      hn::StoreU(AddProduct(weight, step, hn::Set(df, squared)), df, trained);
      trained += lanes;
    }
  }
}

// The trained network along u, read out over the heights of one i.
HWY_INLINE VF ReadAlongU(const float* trained, const float* heights,
                         int count) {
  const DF df;
  VF sum = hn::Zero(df);
  for (int l = 0; l < count; ++l, trained += hn::Lanes(df)) {
    sum = AddProduct(sum, hn::LoadU(df, trained), hn::Set(df, heights[l]));
  }
  return sum;
}

// Method 3: the products of the network along t, read out over what the one
// along u makes of the heights.
void TwoFactorsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                       float* out) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  HWY_ALIGN float trained[(Basis::kMaxCount + 2) * hn::MaxLanes(DF())];
  for (int c = 0; c < run.count; c += lanes) {
    const VU words = hn::LoadU(DU(), run.words + c);
    TrainAlongU(row, words, trained);
    VF sum = hn::Zero(df);
    VF read = hn::Zero(df);
    VF squares = hn::Zero(df);
    const float* input = run.inputs + c;
    const float* heights = row.heights;
    for (int p = 0; p < run.pairs; ++p, input += 2 * run.stride) {
      const InputPair& pair = row.along_t.pairs[p];
      VF weight0 = hn::Set(df, pair.weight[0]);
      VF weight1 = hn::Set(df, pair.weight[1]);
      AddDraws(pair, row.along_t.drawn, words, weight0, weight1);
      const VF read0 = ReadAlongU(trained, heights, 2 * row.pairs_u);
      heights += row.heights_stride;
      const VF read1 = ReadAlongU(trained, heights, 2 * row.pairs_u);
      heights += row.heights_stride;
      AddInput(hn::LoadU(df, input), weight0, hn::Mul(weight0, read0), read0,
               sum, read, squares);
      AddInput(hn::LoadU(df, input + run.stride), weight1,
               hn::Mul(weight1, read1), read1, sum, read, squares);
    }
    hn::StoreU(Trained(run, c, row.along_t.desired, words, sum, read, squares),
               df, out + c);
  }
}

// Method 4: the network along t read out over the heights that the regular
// blend along u gives, plus the regular blend along t of what the network along
// u gives.
void TwoTermsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                     float* out) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  HWY_ALIGN float trained[(Basis::kMaxCount + 2) * hn::MaxLanes(DF())];
  for (int c = 0; c < run.count; c += lanes) {
    const VU words = hn::LoadU(DU(), run.words + c);
    TrainAlongU(row, words, trained);
    VF sum = hn::Zero(df);
    VF read = hn::Zero(df);
    VF squares = hn::Zero(df);
    const float* input = run.inputs + c;
    const float* heights = row.heights;
    for (int p = 0; p < run.pairs; ++p, input += 2 * run.stride) {
      const InputPair& pair = row.along_t.pairs[p];
      VF weight0 = hn::Set(df, pair.weight[0]);
      VF weight1 = hn::Set(df, pair.weight[1]);
      VF readout0 = hn::Set(df, pair.readout[0]);
      VF readout1 = hn::Set(df, pair.readout[1]);
      AddDraws(pair, row.along_t.drawn, words, weight0, weight1, readout0,
               readout1);
      readout0 =
          hn::Add(readout0, ReadAlongU(trained, heights, 2 * row.pairs_u));
      heights += row.heights_stride;
      readout1 =
          hn::Add(readout1, ReadAlongU(trained, heights, 2 * row.pairs_u));
      heights += row.heights_stride;
      AddInput(hn::LoadU(df, input), weight0, readout0,
               hn::Set(df, pair.squared[0]), sum, read, squares);
      AddInput(hn::LoadU(df, input + run.stride), weight1, readout1,
               hn::Set(df, pair.squared[1]), sum, read, squares);
    }
    hn::StoreU(Trained(run, c, row.along_t.desired, words, sum, read, squares),
               df, out + c);
  }
}

HWY_INLINE VF Blend(const ColumnRun& run, int c, const float* control) {
  const DF df;
  VF sum = hn::Zero(df);
  for (int k = 0; k < 2 * run.pairs; ++k) {
    sum = AddProduct(sum, hn::LoadU(df, run.inputs + k * run.stride + c),
                     hn::Set(df, control[k]));
  }
  return sum;
}

void BlendControls(const ColumnRun& run, const float* control, float* out) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  for (int c = 0; c < run.count; c += lanes) {
    hn::StoreU(Blend(run, c, control), df, out + c);
  }
}

void BlendPositions(const ColumnRun& run, const PositionRow& row,
                    const float* heights, float* x, float* y, float* z) {
  const DF df;
  const auto lanes = static_cast<int>(hn::Lanes(df));
  const VF along_x = hn::Set(df, row.direction_x);
  const VF along_y = hn::Set(df, row.direction_y);
  const VF along_z = hn::Set(df, row.direction_z);
  for (int c = 0; c < run.count; c += lanes) {
    const VF height = hn::LoadU(df, heights + c);
    hn::StoreU(AddProduct(Blend(run, c, row.flat_x), height, along_x), df,
               x + c);
    hn::StoreU(AddProduct(Blend(run, c, row.flat_y), height, along_y), df,
               y + c);
    hn::StoreU(AddProduct(Blend(run, c, row.flat_z), height, along_z), df,
               z + c);
  }
}

}  // namespace HWY_NAMESPACE
}  // namespace terrane::core
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace terrane::core {

HWY_EXPORT(OneNetworkHeights);
HWY_EXPORT(TwoFactorsHeights);
HWY_EXPORT(TwoTermsHeights);
HWY_EXPORT(BlendControls);
HWY_EXPORT(BlendPositions);

void OneNetworkHeights(const ColumnRun& run, const OneNetworkRow& row,
                       float* out) {
  HWY_DYNAMIC_DISPATCH(OneNetworkHeights)(run, row, out);
}

void TwoFactorsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                       float* out) {
  HWY_DYNAMIC_DISPATCH(TwoFactorsHeights)(run, row, out);
}

void TwoTermsHeights(const ColumnRun& run, const TwoNetworksRow& row,
                     float* out) {
  HWY_DYNAMIC_DISPATCH(TwoTermsHeights)(run, row, out);
}

void BlendControls(const ColumnRun& run, const float* control, float* out) {
  HWY_DYNAMIC_DISPATCH(BlendControls)(run, control, out);
}

void BlendPositions(const ColumnRun& run, const PositionRow& row,
                    const float* heights, float* x, float* y, float* z) {
  HWY_DYNAMIC_DISPATCH(BlendPositions)(run, row, heights, x, y, z);
}

}  // namespace terrane::core
#endif  // HWY_ONCE
