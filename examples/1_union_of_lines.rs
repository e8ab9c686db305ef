//! Lines through the origin, seen only through the one polynomial that vanishes on all of them, and found again by
//! factoring it. This is the idea of the whole method: what belongs to several models obeys the product of their equations,
//! and that product can be estimated before anything is assigned to a model.

use veronese::factorisation::ternary::factorise;

/// Public: the tests run it, too.
pub fn main() {
    // In the projective plane a line is b·z = b₁z₁ + b₂z₂ + b₃z₃ = 0. Three lines:
    let lines = [[1.0, 2.0, -1.0], [0.5, -1.0, 2.0], [-2.0, 1.0, 1.0]];

    // Their product has ten coefficients, for z₁³, z₁²z₂, z₁²z₃, z₁z₂², …, z₃³. Multiplied out, it shows no line any more.
    let cubic = product(&lines);
    println!("the cubic: {cubic:.2?}");

    let Some(found) = factorise(&cubic, 3) else {
        println!("the cubic does not depend on z₂ and z₃");
        return;
    };
    for line in found {
        // A line is known up to a factor: scaled so that its last entry is the same as above.
        let partner = lines.iter().find(|b| (b[0] * line[2] - line[0] * b[2]).abs() < 1e-9);
        let Some(b) = partner else { continue };
        println!("the line {:.6?}", line.map(|entry| entry * b[2] / line[2]));
    }
}

/// The coefficients of the product of linear forms in three variables, in decreasing order of the powers of z₁, then z₂.
fn product(forms: &[[f64; 3]; 3]) -> Vec<f64> {
    let mut coefficients = vec![0.0; 10];
    for i in 0..3 {
        for j in 0..3 {
            for k in 0..3 {
                let mut powers = [0; 3];
                [i, j, k].iter().for_each(|&variable| powers[variable] += 1);
                let (rest, third) = (3 - powers[0], powers[2]);
                coefficients[rest * (rest + 1) / 2 + third] += forms[0][i] * forms[1][j] * forms[2][k];
            }
        }
    }
    coefficients
}
