!> What is told about steady sliding of a run: for each piece of its programme in which the drive
!> moves, its stability and the values of some keys at which that changes.
module steady_answers
    use, intrinsic :: ieee_arithmetic, only : ieee_quiet_nan, ieee_value
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use linear_stability, only : analyse, critical_value, find_critical, stability, undecided
    use run_settings, only : settings
    use steady_sliding, only : sliding_case, take_piece
    implicit none
    private

    public :: answer_columns, find_answers, steady_answer

    integer, parameter, public :: criticals = 4
    character(len=*), parameter, public :: critical_keys(criticals) = [character(len=16) :: &
        'slider%stiffness', 'drive%velocity', 'slider%damping', 'slider%mass']

    !> What was found for one of these.
    type :: critical_list
        real(dp) :: range(2) = 0.0_dp   !! that was searched
        type(critical_value), allocatable :: found(:)
    contains
        procedure :: closest_to
    end type critical_list

    integer, parameter, public :: n_numbers = 11
    character(len=*), parameter :: answer_columns = 'piece,velocity,normal_traction,friction,' &
        // 'stability,growth_rate,frequency,critical_stiffness,critical_velocity,' &
        // 'critical_damping,critical_mass'

    type :: steady_answer
        integer :: piece = 1           !! of the programme
        type(sliding_case) :: this     !! in it
        type(stability) :: result
        type(critical_list) :: critical(criticals)
    contains
        procedure :: numbers
    end type steady_answer

contains

    !> One for each piece in which the drive moves; one for the first piece if it never does, or if
    !> it follows a file.
    subroutine find_answers(run, answers)
        type(settings), intent(in) :: run
        type(steady_answer), allocatable, intent(out) :: answers(:)
        integer, allocatable :: pieces(:)
        integer :: i

        pieces = pack([(i, i = 1, size(run%drive%start))], abs(run%drive%velocity) > 0.0_dp)
        if (size(pieces) == 0 .or. run%drive%measured_until < huge(1.0_dp)) pieces = [1]
        allocate (answers(size(pieces)))
        do i = 1, size(pieces)
            answers(i)%piece = pieces(i)
            call take_piece(answers(i)%this, run, pieces(i))
            call analyse(answers(i)%this, answers(i)%result)
            call find_all_critical(answers(i))
        end do
    end subroutine find_answers

    !> Critical values of the keys, over decades around the case's own or, where that is 0, around a
    !> value that its forces, stiffness and velocity make up.
    subroutine find_all_critical(answer)
        type(steady_answer), intent(inout) :: answer
        real(dp), parameter :: decades = 6.0_dp
        integer, parameter :: steps = 96
        real(dp), parameter :: nothing = 1.0e-150_dp   !! too small to look around
        real(dp) :: natural(criticals), middle, force
        integer :: i
        logical :: slides

        slides = answer%result%verdict /= undecided
        natural = 0.0_dp
        associate (this => answer%this)
            force = this%area * answer%result%contact%traction
            if (slides) natural = [this%stiffness, abs(this%velocity), &
                force / abs(this%velocity), force**2 / (this%stiffness * this%velocity**2)]
        end associate
        do i = 1, criticals
            associate (list => answer%critical(i), key => critical_keys(i))
                middle = abs(answer%this%value_of(trim(key)))
                if (.not. middle > 0.0_dp) middle = natural(i)
                list%range = middle * 10.0_dp**[-decades, decades]
                if (middle > nothing .and. slides) then
                    call find_critical(answer%this, trim(key), list%range, steps, list%found)
                else
                    allocate (list%found(0))
                end if
            end associate
        end do
    end subroutine find_all_critical

    !> The critical value nearest to another one, by its ratio to that; NaN if there is none.
    pure real(dp) function closest_to(self, value) result(closest)
        class(critical_list), intent(in) :: self
        real(dp), intent(in) :: value   !! where 0 or less, the least one counts as nearest

        closest = ieee_value(closest, ieee_quiet_nan)
        if (size(self%found) == 0) return
        closest = self%found(1)%value
        if (value > 0.0_dp) closest = self%found(minloc(abs(log(self%found%value / value)), &
            1))%value
    end function closest_to

    !> By the columns of `answer_columns`; what does not exist is NaN.
    function numbers(self) result(row)
        class(steady_answer), intent(in) :: self
        real(dp) :: row(n_numbers)
        integer :: i

        row = ieee_value(row, ieee_quiet_nan)
        row(:3) = [real(self%piece, dp), self%this%velocity, self%this%normal]
        associate (contact => self%result%contact)   ! it has a pressure if there is steady sliding
            if (contact%pressure > 0.0_dp) row(3:4) = [contact%pressure, &
                contact%traction / contact%pressure]
        end associate
        row(5) = self%result%verdict
        if (self%result%verdict /= undecided) row(6:7) = [self%result%growth, self%result%frequency]
        do i = 1, criticals
            row(7 + i) = self%critical(i)%closest_to(abs(self%this%value_of( &
                trim(critical_keys(i)))))
        end do
    end function numbers

end module steady_answers
