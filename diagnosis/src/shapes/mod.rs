//! What causes are made of: functions of angle, speed, code, time and revolution, along the radius and along the circle.

pub(crate) mod block;
pub(crate) mod generic;
pub(crate) mod library;
pub(crate) mod trig;
