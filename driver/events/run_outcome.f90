!> What a run has come to.
module run_outcome
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    use piece_measures, only : friction_range
    use energies, only : energy_balance
    implicit none
    private

    public :: event_totals, outcome

    !> Sums over the events of one piece of the programme.
    type :: event_totals
        integer :: events = 0, recurrences = 0
        real(dp) :: period = 0.0_dp, force_drop = 0.0_dp   !! sums; see `recurrences` and `events`
        real(dp) :: peak_velocity = 0.0_dp
    contains
        procedure :: visit
    end type event_totals

    !> What a run has come to.
    type :: outcome
        character(len=:), allocatable :: failure   !! empty if the run reached its end
        real(dp), allocatable :: onsets(:)         !! of the events [T]
        integer :: steps = 0                       !! taken
        integer :: iterations = 0, most_iterations = 0
        logical :: in_rates = .false.              !! iterations are evaluations of rates
        integer :: rejected = 0                    !! steps tried in vain
        integer :: snap_backs = 0                  !! steps that had several equilibria
        real(dp) :: time = 0.0_dp                  !! reached [T]
        real(dp) :: peak_velocity = 0.0_dp         !! [L/T]
        integer :: chain_events = 0                !! in the catalogue of a chain, ended
        real(dp) :: largest_moment = 0.0_dp        !! of them [L^3]
        integer :: cut_events = 0                  !! there, but still under way at the end
        integer :: unresolved = 0                  !! too short for the step to tell, and not there
        type(energy_balance) :: energy
        type(event_totals), allocatable :: pieces(:)
        type(friction_range), allocatable :: friction(:)   !! in the pieces
        logical :: interrupted = .false.           !! by the user: the run can be resumed
    end type outcome

contains

    subroutine visit(self, file)
        class(event_totals), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%events, self%recurrences, self%period, self%force_drop)
        call file%visit(self%peak_velocity)
    end subroutine visit

end module run_outcome
