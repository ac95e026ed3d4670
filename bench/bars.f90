!> What the project has promised of its speed, beside what was measured.
module bars
    use, intrinsic :: iso_fortran_env, only : dp => real64
    use agreement, only : deviation, merge_deviations
    use cost_table, only : table
    implicit none
    private

    public :: write_bars

    real(dp), parameter :: traction_bar = 1.0e-13_dp, tangent_bar = 1.0e-12_dp

contains

    !> Writes the bars. Times may miss them; wrong results may not.
    subroutine write_bars(costs, checked, right)
        type(table), intent(in) :: costs
        type(deviation), intent(in) :: checked   !! of the batch routine, untimed
        logical, intent(out) :: right            !! all results are
        real(dp) :: random, wide
        character(len=100) :: line
        type(deviation) :: batch, scalar

        call costs%say('')
        call costs%say('bar                                                              asked  ' &
            // '  measured')
        random = costs%cost('scalar', 'random', 100000, 1)
        wide = costs%cost('scalar', 'wide', 100000, 1)
        call at_least('scalar, random: times faster than four unknowns', 15.0_dp, &
            ratio(costs%cost('four unknowns', 'random', 10000, 1), random))
        call at_most('scalar, random: times log + sqrt', 12.0_dp, &
            ratio(random, costs%cost('log + sqrt', 'random', 100000, 1)))
        call at_most('scalar, wide: times random', 1.6_dp, ratio(wide, random))
        call at_most('batch, random, 1e5 points, 1 thread: times memcpy', 3.0_dp, &
            copies('random', 100000))
        call at_most('batch, wide, 1e5 points, 1 thread: times memcpy', 5.0_dp, &
            copies('wide', 100000))
        call at_most('batch, random, 1e7 points, 1 thread: times memcpy', 3.0_dp, &
            copies('random', 10000000))
        call at_least('batch, random, 1e6 points: 2 threads times faster than 1', 1.9_dp, &
            ratio(costs%cost('batch', 'random', 1000000, 1), &
            costs%cost('batch', 'random', 1000000, 2)))

        scalar = costs%worst('scalar')
        batch = merge_deviations(costs%worst('batch'), checked)
        call no_more('batch from scalar, traction, by the pressure', traction_bar, batch%traction)
        call no_more('batch from scalar, state, by natural scales', traction_bar, batch%state)
        call no_more('batch from scalar, tangent, by the stiffness', tangent_bar, batch%tangent)
        call none('points that failed, scalar and batch', scalar%failures + batch%failures)
        call none('negative slip increments, scalar and batch', scalar%backward + batch%backward)
        write (line, &
            '(a, es8.1)') 'no bar: slip of batch from scalar, by the displacement since the ' &
            // 'start', batch%slip
        call costs%say(trim(line))
        if (costs%disturbed() > 0) then
            write (line, '(i0, a)') costs%disturbed(), &
                ' rows have a median beyond 1.25 times the ' // 'lowest: the machine was not idle'
            call costs%say(trim(line))
        end if
        right = batch%traction <= traction_bar .and. batch%state <= traction_bar &
            .and. batch%tangent <= tangent_bar .and. scalar%failures + batch%failures &
            + scalar%backward + batch%backward == 0

    contains

        function copies(set, n) result(times)
            character(len=*), intent(in) :: set
            integer, intent(in) :: n      !! points
            real(dp) :: times   !! cost of the batch routine by that of memcpy; < 0 unknown

            times = ratio(costs%cost('batch', set, n, 1), costs%cost('memcpy', '-', n, 1))
        end function copies

        subroutine at_least(what, bar, measured)
            character(len=*), intent(in) :: what
            real(dp), intent(in) :: bar, measured

            call judge(what, '>=', bar, measured, measured >= bar)
        end subroutine at_least

        subroutine at_most(what, bar, measured)
            character(len=*), intent(in) :: what
            real(dp), intent(in) :: bar, measured

            call judge(what, '<=', bar, measured, measured <= bar)
        end subroutine at_most

        subroutine judge(what, sign, bar, measured, met)
            character(len=*), intent(in) :: what, sign
            real(dp), intent(in) :: bar, measured
            logical, intent(in) :: met

            write (line, '(a60, a4, f6.1, f12.2, 2x, a)') what // repeat(' ', 60), sign, bar, &
                measured, verdict(met)
            if (measured < 0.0_dp) write (line(71:), '(a)') '      not measured'
            call costs%say(trim(line))
        end subroutine judge

        subroutine no_more(what, bar, measured)
            character(len=*), intent(in) :: what
            real(dp), intent(in) :: bar, measured

            write (line, '(a60, a4, es6.0e2, es12.1, 2x, a)') what // repeat(' ', 60), '<=', bar, &
                measured, verdict(measured <= bar)
            call costs%say(trim(line))
        end subroutine no_more

        subroutine none(what, measured)
            character(len=*), intent(in) :: what
            integer, intent(in) :: measured

            write (line, '(a60, a4, i6, i12, 2x, a)') what // repeat(' ', 60), '=', 0, measured, &
                verdict(measured == 0)
            call costs%say(trim(line))
        end subroutine none

    end subroutine write_bars

    pure function verdict(met) result(word)
        logical, intent(in) :: met
        character(len=6) :: word

        word = merge('met   ', 'MISSED', met)
    end function verdict

    !> Of two costs; -1 if one of them was not measured.
    pure function ratio(a, b) result(times)
        real(dp), intent(in) :: a
        real(dp), intent(in) :: b
        real(dp) :: times

        times = -1.0_dp
        if (min(a, b) > 0.0_dp) times = a / b
    end function ratio

end module bars
