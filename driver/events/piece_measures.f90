!> What an experimenter reads off the friction of each piece of a loading programme: peak, least and
!> last value; after a change of velocity the direct and the evolution effect, after a hold the
!> healing.
!>
!> Friction is the friction force over the normal force, positive against the motion of the drive.
module piece_measures
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use archive_file, only : archive
    implicit none
    private

    public :: friction_range, piece_effects, read_off

    !> Friction in a piece.
    type :: friction_range
        logical :: seen = .false.      !! there was a normal force
        real(dp) :: peak = 0.0_dp, least = 0.0_dp, last = 0.0_dp
    contains
        procedure :: take, widen, visit
    end type friction_range

    !> What a piece tells beside the one before. With ratio r of the speeds, rate-and-state
    !> friction has the direct effect a ln r, the evolution effect b ln r, and their difference as
    !> change of the steady value; a finite stiffness makes what is seen of the first two smaller.
    type :: piece_effects
        logical :: after_step = .false.        !! the speed changed: the next four are known
        real(dp) :: direct = 0.0_dp            !! first extreme less the last value before
        real(dp) :: evolution = 0.0_dp         !! first extreme less the last value
        real(dp) :: steady_change = 0.0_dp     !! last value less the last value before
        real(dp) :: rate_dependence = 0.0_dp   !! a - b: steady change over ln r
        logical :: after_hold = .false.        !! the drive stood still: the next two are known
        real(dp) :: hold_time = 0.0_dp         !! [T]
        real(dp) :: healing = 0.0_dp           !! peak less the last value before the hold
    end type piece_effects

contains

    !> The next instant.
    pure subroutine take(self, friction)
        class(friction_range), intent(inout) :: self
        real(dp), intent(in) :: friction

        if (.not. self%seen) then
            self%peak = friction
            self%least = friction
        end if
        self%seen = .true.
        self%peak = max(self%peak, friction)
        self%least = min(self%least, friction)
        self%last = friction
    end subroutine take

    !> Takes in the least and the largest value since the last instant.
    pure subroutine widen(self, range)
        class(friction_range), intent(inout) :: self
        real(dp), intent(in) :: range(2)

        if (range(1) > range(2)) return   ! none
        if (.not. self%seen) call self%take(range(2))
        self%least = min(self%least, range(1))
        self%peak = max(self%peak, range(2))
    end subroutine widen

    !> Of all pieces. Where there were events there is no steady value, and nothing is told.
    pure function read_off(ranges, events, velocity, duration) result(effects)
        type(friction_range), intent(in) :: ranges(:)   !! of the pieces
        integer, intent(in) :: events(:)                !! in them
        real(dp), intent(in) :: velocity(:)             !! of the drive in them [L/T]
        real(dp), intent(in) :: duration(:)             !! [T]
        type(piece_effects) :: effects(size(ranges))
        real(dp) :: hold_time
        integer :: before, i

        before = 0   ! piece of the last motion
        hold_time = 0.0_dp
        do i = 1, size(ranges)
            if (.not. abs(velocity(i)) > 0.0_dp) then
                hold_time = hold_time + duration(i)
                cycle
            end if
            if (before > 0) then
                if (ranges(i)%seen .and. ranges(before)%seen .and. events(i) + events(before) == 0 &
                    .and. velocity(i) / velocity(before) > 0.0_dp) effects(i) = &
                    effects_of(ranges(i), ranges(before), velocity(i) / velocity(before), hold_time)
            end if
            before = i
            hold_time = 0.0_dp
        end do
    end function read_off

    pure type(piece_effects) function effects_of(this, before, ratio, hold_time) result(effects)
        type(friction_range), intent(in) :: this, before
        real(dp), intent(in) :: ratio       !! of the speeds, > 0
        real(dp), intent(in) :: hold_time   !! between the two [T]
        real(dp) :: extreme

        effects%after_hold = hold_time > 0.0_dp
        effects%hold_time = hold_time
        effects%healing = this%peak - before%last
        effects%after_step = .not. effects%after_hold .and. abs(ratio - 1.0_dp) > 0.0_dp
        if (.not. effects%after_step) return
        extreme = merge(this%peak, this%least, ratio > 1.0_dp)
        effects%direct = extreme - before%last
        effects%evolution = extreme - this%last
        effects%steady_change = this%last - before%last
        effects%rate_dependence = effects%steady_change / log(ratio)
    end function effects_of

    subroutine visit(self, file)
        class(friction_range), intent(inout) :: self
        type(archive), intent(inout) :: file

        call file%visit(self%seen, self%peak, self%least, self%last)
    end subroutine visit

end module piece_measures
