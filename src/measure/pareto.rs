/// Which points no other is better than in one way and at least as good in the other, of two costs each: by increasing
/// first cost, so that the second decreases. Of equal points the first; points that are not finite count for nothing.
pub fn pareto_front(points: &[[f64; 2]]) -> Vec<usize> {
    let mut order: Vec<usize> =
        (0..points.len()).filter(|&i| !points[i].iter().any(|v| !v.is_finite())).collect();
    order.sort_by(|&a, &b| {
        let [[x, y], [u, v]] = [points[a], points[b]];
        x.total_cmp(&u).then(y.total_cmp(&v))
    });
    let mut least = f64::INFINITY;
    order.retain(|&i| {
        let better = points[i][1] < least;
        least = least.min(points[i][1]);
        better
    });
    order
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn dominates([a, b]: [f64; 2], [c, d]: [f64; 2]) -> bool {
        a <= c && b <= d && (a < c || b < d)
    }

    proptest! {
        #[test]
        fn nothing_is_better_than_the_front_and_all_else_is_worse(
            points in proptest::collection::vec([0..12u8, 0..12u8], 0..40)
        ) {
            // Few values, so that many are equal.
            let points: Vec<[f64; 2]> = points.into_iter().map(|p| p.map(f64::from)).collect();
            let front = pareto_front(&points);
            for (i, point) in points.iter().enumerate() {
                let beaten = points.iter().any(|other| dominates(*other, *point));
                if front.contains(&i) {
                    prop_assert!(!beaten);
                } else {
                    prop_assert!(beaten || front.iter().any(|&f| points[f] == *point && f < i));
                }
            }
            for pair in front.windows(2) {
                prop_assert!(points[pair[0]][0] < points[pair[1]][0] && points[pair[0]][1] > points[pair[1]][1]);
            }
        }
    }

    #[test]
    fn what_is_not_finite_is_in_no_front() {
        assert_eq!(
            pareto_front(&[[f64::NAN, 0.0], [1.0, f64::NAN], [2.0, 3.0], [1.0, 0.0], [0.0, f64::INFINITY]]),
            [3]
        );
        assert!(pareto_front(&[]).is_empty());
    }
}
