//! The direction in which the scale came to where it is.

/// Share of the highest speed below which a scale rests: noise of a motion that was measured turns back and forth there.
const REST: f64 = 0.01;

/// 1 or −1 at each speed: at rest the direction before goes on, until the scale moves the other way; then it turned where its
/// speed was zero last. Before any motion it is the first that comes.
pub(crate) fn sides(speed: &[f64]) -> Vec<f64> {
    let highest = speed.iter().fold(0.0, |most, v| v.abs().max(most));
    let moves = |v: &&f64| v.abs() > REST * highest;
    let mut side = speed.iter().find(moves).map_or(1.0, |v| v.signum());
    let mut turned = 0;
    let mut sides = vec![side; speed.len()];
    for (k, v) in speed.iter().enumerate() {
        if *v == 0.0 || v.signum() == side {
            turned = k + 1;
        } else if moves(&v) {
            side = -side;
            sides[turned..k].fill(side);
            turned = k + 1;
        }
        sides[k] = side;
    }
    sides
}

#[cfg(test)]
mod tests {
    use super::sides;

    #[test]
    fn what_rests_keeps_its_direction_until_it_moves_the_other_way() {
        let speed = [
            0.0, 1.0, 0.004, -0.004, 0.0, 0.004, 0.5, 0.003, -0.002, -0.5, 0.0,
        ];
        let expected = [1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, 1.0, -1.0, -1.0, -1.0];
        assert_eq!(sides(&speed), expected);
        assert_eq!(sides(&[0.0, 0.0]), [1.0, 1.0]);
        assert_eq!(sides(&[]), [0.0; 0]);
        assert_eq!(sides(&[0.0, -1.0]), [-1.0, -1.0]);
    }
}
