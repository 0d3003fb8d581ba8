//! Functions in OpenSim models: the rotation or translation of a joint along an axis, by its coordinates.

use roxmltree::Node;

use super::super::xml::{child, is, place};
use super::super::{ParseError, Warning};
use super::values::numbers;

/// A function of the values of coordinates.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Function {
    Constant(f64),
    /// A factor for each coordinate and a constant behind them.
    Linear(Vec<f64>),
    /// Coefficients, that of the highest power first.
    Polynomial(Vec<f64>),
    /// Points joined by lines.
    Piecewise(Vec<(f64, f64)>),
    Spline(CubicSpline),
    Scaled(f64, Box<Function>),
}

impl Function {
    pub(super) fn identity() -> Self {
        Self::Linear(vec![1.0, 0.0])
    }

    /// True for the identity, up to its sign.
    pub(super) fn is_identity(&self) -> bool {
        matches!(self, Self::Linear(terms) if matches!(terms[..], [factor, 0.0] if factor.abs() == 1.0))
    }

    /// The value at `inputs`; all but linear functions take the first alone.
    pub(super) fn at(&self, inputs: &[f64]) -> f64 {
        let input = inputs.first().copied().unwrap_or(0.0);
        match self {
            Self::Constant(value) => *value,
            Self::Linear(terms) => {
                let (constant, factors) = terms.split_last().unwrap_or((&0.0, &[]));
                constant + factors.iter().zip(inputs).map(|(f, x)| f * x).sum::<f64>()
            }
            Self::Polynomial(terms) => terms.iter().fold(0.0, |sum, term| sum * input + term),
            Self::Piecewise(points) => piecewise(points, input),
            Self::Spline(spline) => spline.at(input),
            Self::Scaled(scale, function) => scale * function.at(inputs),
        }
    }

    /// The function in `holder`: itself or below an element `function`; `None` if there is none.
    ///
    /// # Errors
    /// A function of another kind, or without the numbers it needs.
    pub(super) fn in_element(holder: Node<'_, '_>) -> Result<Option<Self>, ParseError> {
        const DEEPEST: usize = 8;
        Self::below(holder, DEEPEST)
    }

    fn below(holder: Node<'_, '_>, depth: usize) -> Result<Option<Self>, ParseError> {
        let holder = child(holder, "function").unwrap_or(holder);
        let names_one = |n: &Node<'_, '_>| {
            let name = n.tag_name().name();
            n.is_element()
                && (name.ends_with("Function") || name.ends_with("Spline") || name == "Constant")
        };
        match holder.children().find(names_one) {
            Some(node) if depth > 0 => Self::of(node, depth).map(Some),
            Some(node) => Err(ParseError::new(
                place(node),
                "functions less deep in each other",
                "more",
            )),
            None => Ok(None),
        }
    }

    fn of(node: Node<'_, '_>, depth: usize) -> Result<Self, ParseError> {
        let list = |tag: &str| numbers(node, tag, None);
        let points = || -> Result<Vec<(f64, f64)>, ParseError> {
            let (x, y) = (list("x")?, list("y")?);
            let increase = x.windows(2).all(|w| w[0] < w[1]);
            match x.len() == y.len() && !x.is_empty() && increase {
                true => Ok(x.into_iter().zip(y).collect()),
                false => {
                    let found = format!(
                        "{} of x and {} of y, or x that does not increase",
                        x.len(),
                        y.len()
                    );
                    Err(ParseError::new(
                        place(node),
                        "as many increasing x as y",
                        found,
                    ))
                }
            }
        };
        Ok(match node.tag_name().name() {
            "Constant" => Self::Constant(list("value")?.first().copied().unwrap_or(0.0)),
            "LinearFunction" => Self::Linear(list("coefficients")?),
            "PolynomialFunction" => Self::Polynomial(list("coefficients")?),
            "PiecewiseLinearFunction" => Self::Piecewise(points()?),
            "SimmSpline" | "GCVSpline" => Self::Spline(CubicSpline::through(points()?)),
            "MultiplierFunction" => {
                let scale = list("scale")?.first().copied().unwrap_or(1.0);
                let inner = Self::below(node, depth - 1)?.unwrap_or(Self::Constant(0.0));
                Self::Scaled(scale, Box::new(inner))
            }
            other => {
                let expected =
                    "a constant, linear, polynomial or piecewise linear function, or a spline";
                return Err(ParseError::new(place(node), expected, format!("<{other}>")));
            }
        })
    }
}

/// Warns if a joint is moved by a smoothing spline, which is read as an interpolating one.
pub(super) fn warn_of_smoothing(model: Node<'_, '_>, warnings: &mut Vec<Warning>) {
    let other = model
        .descendants()
        .find(|n| is(*n, "TransformAxis") && n.descendants().any(|f| is(f, "GCVSpline")));
    if let Some(node) = other {
        let text =
            "a smoothing spline (GCVSpline) moves a joint; it is read as one through its points";
        warnings.push(Warning::new(place(node), text));
    }
}

fn piecewise(points: &[(f64, f64)], x: f64) -> f64 {
    let Some(&first) = points.first() else {
        return 0.0;
    };
    let at = points
        .partition_point(|p| p.0 <= x)
        .clamp(1, points.len().max(2) - 1);
    let Some(&after) = points.get(at) else {
        return first.1;
    };
    let before = points[at - 1];
    before.1 + (x - before.0) * (after.1 - before.1) / (after.0 - before.0)
}

/// A cubic spline through points whose third derivative at each end is that of the cubic through the four points there (Forsythe,
/// Malcolm & Moler, *Computer Methods for Mathematical Computations*, 1977, section 4.4), as SIMM and OpenSim use it. Beyond its ends it
/// goes straight on.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct CubicSpline {
    points: Vec<(f64, f64)>,
    /// A sixth of the second derivative, at each point.
    bends: Vec<f64>,
}

impl CubicSpline {
    fn through(points: Vec<(f64, f64)>) -> Self {
        let bends = bends(&points);
        Self { points, bends }
    }

    fn at(&self, x: f64) -> f64 {
        let points = &self.points;
        let n = points.len();
        if n < 3 {
            return piecewise(points, x);
        }
        let (first, last) = (points[0], points[n - 1]);
        if x < first.0 {
            return first.1 + (x - first.0) * self.slope(0, 0.0);
        }
        if x > last.0 {
            return last.1 + (x - last.0) * self.slope(n - 2, 1.0);
        }
        let k = points.partition_point(|p| p.0 <= x).clamp(1, n - 1) - 1;
        let width = points[k + 1].0 - points[k].0;
        let t = (x - points[k].0) / width;
        let s = 1.0 - t;
        let straight = s * points[k].1 + t * points[k + 1].1;
        straight
            + width
                * width
                * ((s * s * s - s) * self.bends[k] + (t * t * t - t) * self.bends[k + 1])
    }

    /// The derivative in the `k`th piece, at the share `t` of it.
    fn slope(&self, k: usize, t: f64) -> f64 {
        let ((x, y), (next_x, next_y)) = (self.points[k], self.points[k + 1]);
        let width = next_x - x;
        let s = 1.0 - t;
        let bend = (1.0 - 3.0 * s * s) * self.bends[k] + (3.0 * t * t - 1.0) * self.bends[k + 1];
        (next_y - y) / width + width * bend
    }
}

/// Solves the tridiagonal system of the cited section. O(points).
fn bends(points: &[(f64, f64)]) -> Vec<f64> {
    let n = points.len();
    if n < 3 {
        return vec![0.0; n];
    }
    let width = |k: usize| points[k + 1].0 - points[k].0;
    let slope = |k: usize| (points[k + 1].1 - points[k].1) / width(k);
    let mut diagonal = vec![0.0; n];
    let mut right = vec![0.0; n];
    diagonal[0] = -width(0);
    diagonal[n - 1] = -width(n - 2);
    for k in 1..n - 1 {
        diagonal[k] = 2.0 * (width(k - 1) + width(k));
        right[k] = slope(k) - slope(k - 1);
    }
    if n > 3 {
        // Third differences at the ends.
        let third = |k: usize| {
            let second = |k: usize| (slope(k + 1) - slope(k)) / (points[k + 2].0 - points[k].0);
            (second(k + 1) - second(k)) / (points[k + 3].0 - points[k].0)
        };
        right[0] = width(0).powi(2) * third(0);
        right[n - 1] = -width(n - 2).powi(2) * third(n - 4);
    }
    for k in 1..n {
        let factor = width(k - 1) / diagonal[k - 1];
        diagonal[k] -= factor * width(k - 1);
        right[k] -= factor * right[k - 1];
    }
    right[n - 1] /= diagonal[n - 1];
    for k in (0..n - 1).rev() {
        right[k] = (right[k] - width(k) * right[k + 1]) / diagonal[k];
    }
    right
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// A cubic has the third derivative of any four of its points: the spline is the cubic itself.
        #[test]
        fn a_cubic_is_its_own_spline(c in prop::array::uniform4(-2.0f64..2.0), n in 4usize..9, x in -2.0f64..2.0) {
            let cubic = |x: f64| c.iter().fold(0.0, |sum, c| sum * x + c);
            let points: Vec<_> = (0..n).map(|k| -2.0 + 4.0 * k as f64 / (n - 1) as f64).map(|x| (x, cubic(x))).collect();
            let spline = CubicSpline::through(points);
            prop_assert!((spline.at(x) - cubic(x)).abs() < 1e-9);
        }

        #[test]
        fn a_spline_passes_its_points(y in prop::collection::vec(-1.0f64..1.0, 1..10)) {
            let points: Vec<_> = y.iter().enumerate().map(|(k, &y)| ((k * k) as f64, y)).collect();
            let spline = CubicSpline::through(points.clone());
            for (x, y) in points {
                prop_assert!((spline.at(x) - y).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn beyond_the_ends_it_goes_straight_on() {
        let spline = CubicSpline::through((0..5).map(f64::from).map(|x| (x, x * x)).collect());
        for (x, expected) in [(6.0, 16.0 + 2.0 * 8.0), (-2.0, 0.0)] {
            assert!((spline.at(x) - expected).abs() < 1e-9, "{x}");
        }
        assert_eq!(piecewise(&[(0.0, 1.0), (1.0, 3.0)], 2.0), 5.0);
        assert_eq!(piecewise(&[(0.0, 1.0)], 2.0), 1.0);
    }

    #[test]
    fn functions_of_coordinates() {
        assert_eq!(
            Function::Linear(vec![2.0, 3.0, 1.0]).at(&[10.0, 100.0]),
            321.0
        );
        assert_eq!(Function::Polynomial(vec![1.0, 0.0, -1.0]).at(&[3.0]), 8.0);
        let halved = Function::Scaled(0.5, Box::new(Function::identity()));
        assert_eq!(halved.at(&[3.0]), 1.5);
        assert_eq!(Function::Constant(4.0).at(&[]), 4.0);
    }
}
