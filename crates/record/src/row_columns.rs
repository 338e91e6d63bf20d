//! Reading of rows from columns, the inverse of what `Columns::push` writes.

use super::columns::{Column, Columns};
use super::row::{Source, TopicRow};
use crate::enum_label::LoggedEnum;

impl Columns {
    /// Reads the rows of a topic, each with its time (s), from columns of a log; `None` if a column is missing, as in logs of
    /// other versions.
    pub fn timed_rows<R: TopicRow>(&self) -> Option<Vec<(f64, R)>> {
        let times = self.numbers("time_s")?;
        let rows = R::read_rows(self, "")?;
        (rows.len() == times.len()).then(|| times.iter().copied().zip(rows).collect())
    }
}

impl Source for Columns {
    fn read_numbers(&self, name: &str) -> Option<Vec<f64>> {
        self.numbers(name).map(<[f64]>::to_vec)
    }

    fn read_counts(&self, name: &str) -> Option<Vec<u64>> {
        if let Some(Column::Counts(counts)) = self.get(name) { Some(counts.clone()) } else { None }
    }

    fn read_labels(&self, name: &str, labels: &LoggedEnum) -> Option<Vec<usize>> {
        let Some(Column::Labels(indices, names)) = self.get(name) else { return None };
        let place = |name: &String| labels.values.iter().position(|label| label == name);
        let known: Vec<Option<usize>> = names.iter().map(place).collect();
        indices.iter().map(|index| known.get(usize::from(*index)).copied().flatten()).collect()
    }

    fn read_texts(&self, name: &str) -> Option<Vec<String>> {
        if let Some(Column::Texts(texts)) = self.get(name) { Some(texts.clone()) } else { None }
    }

    fn read_times(&self, name: &str) -> Option<Vec<u64>> {
        Some(self.numbers(name)?.iter().map(|seconds| libm::round(seconds * 1e9) as u64).collect())
    }

    fn nested_rows(&self, name: &str) -> Option<(&[u32], &Self)> {
        if let Some(Column::Rows(counts, inner)) = self.get(name) { Some((counts, inner)) } else { None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::row::FieldType;
    use crate::{Hinges, Jets, Metric, Metrics, Orbit, OrbitAxis, Torque, Torques};
    use crate::{Light, states::Sliding};

    /// Returns the columns of rows, with times 0, 1, 2 and so on.
    fn columns<R: TopicRow>(rows: &[R]) -> Columns {
        let mut columns = Columns::new(R::FIELDS);
        for row in rows {
            columns.push(row);
        }
        let times = (0..rows.len()).map(|index| index as f64).collect();
        columns.columns.insert(0, ("time_s".to_owned(), Column::Numbers(times)));
        columns
    }

    fn read_back<R: TopicRow + Clone + PartialEq + std::fmt::Debug>(rows: &[R]) {
        let expected: Vec<(f64, R)> =
            rows.iter().enumerate().map(|(index, row)| (index as f64, row.clone())).collect();
        assert_eq!(columns(rows).timed_rows::<R>(), Some(expected));
    }

    #[test]
    fn rows_are_read_as_they_were_written() {
        let jets = |fuel_kg| Jets { roll_on_s: 0.1, pitch_on_s: -0.2, yaw_on_s: 0.0, fuel_kg };
        read_back(&[jets(0.5), jets(1.5)]);
        let torque =
            |applied_nm| Torque { feedforward_nm: 0.0, feedback_nm: 1.0, applied_nm, disturbance_nm: 3.0 };
        read_back(&[Torques { axes: vec![torque(1.0), torque(2.0)] }, Torques { axes: Vec::new() }]);
        let axis = OrbitAxis { position_m: 1.0, velocity_m_s: 2.0, nadir: 3.0, field_t: 4.0, sun: 5.0 };
        let orbit = |light| Orbit { axes: vec![axis.clone(); 3], light, sunlight: 0.5 };
        read_back(&[orbit(Light::Lit), orbit(Light::Shadow)]);
        let metric = |name: &str, index| Metric {
            name: name.to_owned(),
            unit: String::new(),
            index,
            value: 1.0,
            text: "met".to_owned(),
        };
        read_back(&[Metrics { metrics: vec![metric("a", 0), metric("a", 1)] }]);
        read_back::<Hinges>(&[]);
    }

    #[test]
    fn columns_of_another_form_are_no_rows() {
        let whole = columns(&[Torques { axes: Vec::new() }]);
        assert!(whole.timed_rows::<Jets>().is_none());
        let foreign = Columns {
            columns: vec![(
                "sliding".to_owned(),
                Column::Labels(vec![1], vec!["stuck".into(), "gone".into()]),
            )],
        };
        assert_eq!(Sliding::read_values(&foreign, "sliding"), None);
    }
}
