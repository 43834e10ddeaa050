/// Why a graphics processor did not draw.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum GpuError {
    /// None was found.
    #[error(
        "there is no graphics processor to draw with: no driver for Vulkan, Metal or DirectX 12 offers one"
    )]
    NoAdapter,
    /// It cannot do what is needed.
    #[error("{adapter} cannot be used: {why}")]
    Unfit {
        /// Which.
        adapter: String,
        /// Why.
        why: String,
    },
    /// What is to be drawn is more than it holds.
    #[error("{adapter} has no room for {what}: {bytes} bytes where it takes {most} at a time")]
    TooLarge {
        /// Which.
        adapter: String,
        /// Of what there is too much.
        what: &'static str,
        /// How much there is.
        bytes: u64,
        /// How much there may be.
        most: u64,
    },
    /// Its memory is full.
    #[error("{adapter} is out of memory")]
    OutOfMemory {
        /// Which.
        adapter: String,
    },
    /// It has stopped answering.
    #[error("{adapter} was lost: {why}")]
    Lost {
        /// Which.
        adapter: String,
        /// What its driver says.
        why: String,
    },
    /// Its driver refused what it was asked to do.
    #[error("{adapter} refused to draw: {why}")]
    Refused {
        /// Which.
        adapter: String,
        /// What its driver says.
        why: String,
    },
}
